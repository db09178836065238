// SPDX-License-Identifier: GPL-3.0-or-later
// The list of windows: its columns, sorting and filters; pictures of the visible rows only; rejections with
// mouse and keys.
#include "core/base/time.h"
#include "tests/support/test_program.h"
#include "tests/ui/other_load.h"
#include "tests/ui/recorded_windows.h"
#include "tests/ui/screenshots.h"
#include "ui/detection/window_list.h"
#include "ui/detection/window_panel.h"
#include "ui/theme/theme.h"

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QScrollBar>
#include <QSignalSpy>
#include <QTreeView>

#include <algorithm>
#include <set>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

namespace {

using Model = WindowListModel;

CircleResidual residualOf(int view, int circle, double x_px) {
  CircleResidual residual;
  residual.view = view;
  residual.circle = circle;
  residual.centre_px = Eigen::Vector2d(100.0, 100.0);
  residual.sigma_px = Eigen::Vector2d(0.05, 0.05);
  residual.residual_px = Eigen::Vector2d(x_px, 0.0);
  return residual;
}

// Windows of 20 ms: of ten consecutive ones, one is missed, two are partial, the others complete. Residuals
// of the k-th view are k thousandths of a pixel, its circles move by 10 k px/s.
std::shared_ptr<CalibrationRun> runOf(int windows) {
  auto run = std::make_shared<CalibrationRun>();
  run->detections.cameras.resize(1);
  BoardObservations& seen = run->detections.cameras[0];
  for (int k = 0; k < windows; ++k) {
    WindowReport report{0.01 + 0.02 * k, 0.01, WindowOutcome::Complete, 900, 50, 44, true};
    if (k % 10 == 3) report.outcome = k % 20 == 3 ? WindowOutcome::TooFewEvents : WindowOutcome::NoLattice;
    if (k % 10 == 5 || k % 10 == 6) report.outcome = WindowOutcome::Partial;
    if (k % 10 == 3) report.circles = 0;
    seen.windows.push_back(report);
    if (k % 10 == 3) continue;
    const auto view = static_cast<int>(seen.views.size());
    BoardView found{report.time_s, k % 10 == 5 || k % 10 == 6 ? ViewKind::Partial : ViewKind::Complete, {}};
    for (int circle = 0; circle < 3; ++circle) {
      CircleObservation each;
      each.circle = circle;
      each.velocity_px_s = Eigen::Vector2d(0.0, 10.0 * view);
      found.circles.push_back(each);
      CircleResidual residual = residualOf(view, circle, circle == 2 ? 7.0 : 0.001 * view);
      residual.used = circle != 2;  // an outlier, which the run dropped
      run->result.circle_residuals.push_back(residual);
    }
    seen.views.push_back(found);
  }
  return run;
}

struct Listed : WindowList {
  explicit Listed(std::shared_ptr<CalibrationRun> run) {
    resize(460, 500);
    show();
    QSignalSpy done(this, &WindowList::filled);
    setRun(std::move(run), 0, "none");
    QVERIFY(done.wait(20'000 * kSlowdown));
    setRejectable(true);
  }
  QTreeView& table() { return *findChild<QTreeView*>("windows"); }
  QString text(int row, int column) { return table().model()->index(row, column).data().toString(); }
  QString second(int row) {
    return table().model()->index(row, Model::State).data(Model::kSecondLineRole).toString();
  }
  void sortBy(int column) {  // by a click on the header
    QHeaderView& header = *table().header();
    const QPoint at(header.sectionViewportPosition(column) + header.sectionSize(column) / 2,
                    header.height() / 2);
    QTest::mouseClick(header.viewport(), Qt::LeftButton, {}, at);
  }
  void click(int row, Qt::KeyboardModifiers modifiers = {}) {
    const QRect cell = table().visualRect(table().model()->index(row, Model::State));
    QTest::mouseClick(table().viewport(), Qt::LeftButton, modifiers, cell.center());
  }
  QPushButton& button(const QString& text) {
    for (QPushButton* const each : findChildren<QPushButton*>())
      if (each->text() == text) return *each;
    qFatal("no such button");
  }
  QString said() {
    QStringList texts;
    for (const QLabel* const label : findChildren<QLabel*>())
      if (label->isVisible()) texts << label->text();
    return texts.join('\n');
  }
};

std::vector<double> timesOf(const QSignalSpy& spy) {
  return spy.last().at(0).value<std::vector<double>>();
}

int visibleRows(const QTreeView& table) {
  int rows = 0;
  for (QModelIndex at = table.indexAt({1, 1}); at.isValid(); at = table.indexBelow(at)) {
    if (table.visualRect(at).top() > table.viewport()->height()) break;
    ++rows;
  }
  return rows;
}

}  // namespace

class TestWindowList : public QObject {
  Q_OBJECT

  std::unique_ptr<Recorded> recorded_;

 private slots:
  void initTestCase() {
    applyTheme(*qApp, Appearance::Light);
    recorded_ = std::make_unique<Recorded>();
  }

  void rows_sayWhatTheRunFound() {
    Listed list(runOf(40));
    QCOMPARE(list.shownCount(), 40);
    QCOMPARE(list.text(0, Model::Time), QString("0.010"));
    QCOMPARE(list.text(12, Model::State), QString("Complete"));
    QCOMPARE(list.text(12, Model::Circles), QString("44"));
    QCOMPARE(list.text(12, Model::Rms), QString("0.011"));  // the view's number is 11: one window was missed
    QCOMPARE(list.text(12, Model::Speed), QString("110"));
    QCOMPARE(list.text(5, Model::State), QString("Partial"));
    QCOMPARE(list.text(3, Model::State), QString("Missed"));
    QCOMPARE(list.second(3), QString("too few events"));
    QCOMPARE(list.second(13), QString("no lattice"));
    QCOMPARE(list.text(3, Model::Rms), QString("\u2013"));
    QVERIFY(list.table().model()->index(3, 0).data(Qt::ToolTipRole).toString().contains("too few events"));
    QVERIFY(list.said().contains("40 of 40"));
  }

  void withoutARun_itSaysWhatToDo() {
    WindowList list;
    list.resize(460, 500);
    list.show();
    list.setRun(nullptr, 0, "Calibrate first");
    QCOMPARE(list.shownCount(), 0);
    QVERIFY(!list.findChild<QTreeView*>()->isVisible());
    for (const QPushButton* const button : list.findChildren<QPushButton*>()) QVERIFY(!button->isEnabled());
  }

  void everyColumn_sorts_data() {
    QTest::addColumn<int>("column");
    QTest::newRow("time") << int(Model::Time);
    QTest::newRow("state") << int(Model::State);
    QTest::newRow("circles") << int(Model::Circles);
    QTest::newRow("RMS") << int(Model::Rms);
    QTest::newRow("speed") << int(Model::Speed);
  }
  void everyColumn_sorts() {
    QFETCH(int, column);
    Listed list(runOf(300));
    list.sortBy(column == Model::Time ? int(Model::Rms) : int(Model::Time));
    for (int turn = 0; turn < 2; ++turn) {
      list.sortBy(column);
      const bool ascending = list.table().header()->sortIndicatorOrder() == Qt::AscendingOrder;
      QCOMPARE(list.table().header()->sortIndicatorSection(), column);
      for (int row = 1; row < list.shownCount(); ++row) {
        const double before = list.table().model()->index(row - 1, column).data(Model::kSortRole).toDouble();
        const double here = list.table().model()->index(row, column).data(Model::kSortRole).toDouble();
        QVERIFY(ascending ? before <= here : before >= here);
      }
    }
  }

  void filters_showTheirs() {
    Listed list(runOf(300));
    auto* const box = list.findChild<QComboBox*>();
    const auto shown = [&](WindowFilter filter) {
      box->setCurrentIndex(static_cast<int>(filter));
      return list.shownCount();
    };
    QCOMPARE(shown(WindowFilter::Missed), 30);
    QVERIFY(list.said().contains("30 of 300"));
    QCOMPARE(list.text(0, Model::State), QString("Missed"));
    QCOMPARE(shown(WindowFilter::Partial), 60);
    QCOMPARE(shown(WindowFilter::Rejected), 0);
    list.setRejected({0.01});
    QCOMPARE(list.shownCount(), 1);
    QCOMPARE(shown(WindowFilter::Worst), 27);  // a tenth of those with the board, the worst first
    QCOMPARE(list.text(0, Model::Rms), QString("0.269"));
    QCOMPARE(shown(WindowFilter::All), 300);
  }

  void rejectAndKeep_byKeysAndButtons_ofOneAndMany() {
    Listed list(runOf(40));
    QSignalSpy wanted(&list, &WindowList::rejectionWanted);
    list.click(1);
    list.table().setFocus();
    QTest::keyClick(&list.table(), Qt::Key_Delete);
    QCOMPARE(wanted.count(), 1);
    QCOMPARE(timesOf(wanted), std::vector{0.01 + 0.02});
    QCOMPARE(list.text(1, Model::State), QString("Complete"));  // until the document changes
    list.setRejected(timesOf(wanted));
    list.setPending(1, 0);
    QCOMPARE(list.text(1, Model::State), QString("Rejected"));
    QCOMPARE(list.second(1), QString("in the next run"));
    QVERIFY(list.said().contains("1 to be rejected"));
    QVERIFY(!list.button("Reject").isEnabled());
    // Rows 2 to 4, of which the middle one was missed: it has nothing to reject.
    list.click(2);
    list.click(4, Qt::ShiftModifier);
    QCOMPARE(list.selectedWindows(), (std::vector{2, 3, 4}));
    QTest::mouseClick(&list.button("Reject"), Qt::LeftButton);
    QCOMPARE(timesOf(wanted), (std::vector{0.01 + 0.02, 0.01 + 0.02 * 2, 0.01 + 0.02 * 4}));
    QCOMPARE(wanted.last().at(1).toString(), QString("Reject 2 windows"));
    list.setRejected(timesOf(wanted));
    list.click(1);
    list.table().setFocus();
    QTest::keyClick(&list.table(), Qt::Key_Delete, Qt::ShiftModifier);
    QCOMPARE(timesOf(wanted), (std::vector{0.01 + 0.02 * 2, 0.01 + 0.02 * 4}));
    // During a run, and for runs that cannot be repeated, nothing is requested.
    const auto asked = wanted.count();
    list.setBusy(true);
    QVERIFY(!list.button("Reject").isEnabled());
    QTest::keyClick(&list.table(), Qt::Key_Delete);
    list.setBusy(false);
    list.setRejectable(false);
    QTest::keyClick(&list.table(), Qt::Key_Delete);
    QCOMPARE(wanted.count(), asked);
  }

  void cursorAndRow_followEachOther() {
    Listed list(runOf(300));
    QSignalSpy chosen(&list, &WindowList::windowChosen);
    list.setTime(0.01 + 0.02 * 200 + 0.004);
    QCOMPARE(list.selectedWindows(), std::vector{200});
    QVERIFY(list.table().viewport()->rect().contains(
        list.table().visualRect(list.table().currentIndex().siblingAtColumn(Model::State)).center()));
    QVERIFY(chosen.isEmpty());  // not by the user
    QTest::keyClick(&list.table(), Qt::Key_Down);
    QCOMPARE(chosen.count(), 1);
    QCOMPARE(chosen[0][0].toDouble(), 0.01 + 0.02 * 201);
    list.setTime(chosen[0][0].toDouble());
    QCOMPARE(list.selectedWindows(), std::vector{201});
    QCOMPARE(chosen.count(), 1);
    // Selected rows stay selected.
    list.setTime(0.01);
    list.click(0);
    list.click(2, Qt::ControlModifier);
    list.setTime(0.01 + 0.02 * 7);
    QCOMPARE(list.selectedWindows(), (std::vector{0, 2}));
  }

  void tenThousandWindows_areRowsWithoutWidgets() {
    Listed list(runOf(10'000));
    QCOMPARE(list.shownCount(), 10'000);
    QVERIFY(list.findChildren<QWidget*>().size() < 60);
    const ComputedTime computed;
    for (int k = 0; k < 200; ++k) list.setTime(0.01 + 0.02 * (37 * k % 10'000));
    list.sortBy(Model::Rms);
    QApplication::processEvents();
    QVERIFY2(computed.elapsed_ms() < 5000.0 * slowness(), qPrintable(QString::number(computed.elapsed_ms())));
  }

  void pictures_areMadeOfRowsInViewOnly() {
    DetectionScreen screen;
    screen.resize(1000, 800);
    screen.show();
    screen.setSession(recorded_->session);
    screen.setRun(recorded_->run(), recorded_->session);
    QTRY_VERIFY_WITH_TIMEOUT(screen.timeline().end_s() > 1.9, 20'000 * kSlowdown);
    WindowList& list = screen.windowList();
    QVERIFY(!list.isVisible());
    QTest::qWait(200);
    QCOMPARE(list.pictures().count(), 0);
    screen.setWindowsListed(true);
    auto& table = *list.findChild<QTreeView*>("windows");
    QTRY_VERIFY(list.shownCount() > 30);
    const int in_view = visibleRows(table);
    QVERIFY(in_view > 3 && in_view < list.shownCount() / 2);
    QTRY_COMPARE_WITH_TIMEOUT(list.pictures().count(), in_view, 20'000 * kSlowdown);
    QTest::qWait(200);
    QVERIFY(list.pictures().count() <= in_view + 1);
    const int last = list.shownCount() - 1;
    QVERIFY(list.pictures().of(last) == nullptr);
    table.verticalScrollBar()->setValue(table.verticalScrollBar()->maximum());
    QTRY_VERIFY_WITH_TIMEOUT(list.pictures().of(last) != nullptr, 20'000 * kSlowdown);
    QVERIFY(list.pictures().count() <= WindowPictures::kMaxKept);
    const QImage picture = list.pictures().of(last)->toImage();
    QVERIFY(picture.width() <= kPictureSize_px.width() && picture.height() <= kPictureSize_px.height());
    QVERIFY(picture.height() == kPictureSize_px.height() || picture.width() == kPictureSize_px.width());
    std::set<QRgb> colours;
    for (int x = 0; x < picture.width(); ++x) colours.insert(picture.pixel(x, picture.height() / 2));
    QVERIFY(colours.size() > 4);  // something is visible
  }

  void picture_ofAFrameIsTheFrame() {
    QTemporaryDir folder;
    auto frames = std::make_shared<FrameCache>(folder.path().toStdString());
    for (int k = 0; k < 3; ++k) {
      Frame frame;
      frame.time_ns = nanosecondsFrom(0.1 * k);
      frame.size_px = {8, 4};
      frame.row_bytes = 8;
      frame.bytes.assign(32, static_cast<std::uint8_t>(80 * k));
      frames->append(frame);
    }
    PictureSource source{CameraKind::Frames, nullptr, frames, 0, {8, 4}};
    const QImage picture = pictureOfWindow(source, {0, 0.1, 0.0}, {}, {16, 16});
    QCOMPARE(picture.size(), QSize(16, 8));
    QCOMPARE(qGray(picture.pixel(5, 5)), 80);
    QVERIFY(pictureOfWindow(source, {0, 0.5, 0.0}, {}, {16, 16}).isNull());  // not read yet
  }

  void missedWindows_areSteppedTo_andTheListFollows() {
    auto run = recorded_->run();
    std::vector<WindowReport>& windows = run->detections.cameras[0].windows;
    const auto spoil = [&](std::size_t k) {
      windows[k].outcome = WindowOutcome::NoLattice;
      std::erase_if(run->detections.cameras[0].views,
                    [&](const BoardView& view) { return view.time_s == windows[k].time_s; });
    };
    for (WindowReport& window : windows)
      if (window.outcome != WindowOutcome::Partial) window.outcome = WindowOutcome::Complete;
    spoil(10);
    spoil(30);
    DetectionScreen screen;
    screen.resize(1000, 650);
    screen.show();
    QVERIFY(QTest::qWaitForWindowActive(&screen));
    screen.setSession(recorded_->session);
    screen.setRun(run, recorded_->session);
    QTRY_VERIFY_WITH_TIMEOUT(screen.timeline().end_s() > 1.9, 20'000 * kSlowdown);
    QTest::keyClick(&screen, Qt::Key_W);
    QVERIFY(screen.windowList().isVisible());
    QTRY_VERIFY(screen.windowList().shownCount() > 30);
    screen.setTime(0.0);
    QTest::keyClick(&screen, Qt::Key_M);
    QCOMPARE(screen.time_s(), windows[10].time_s);
    QCOMPARE(screen.windowList().selectedWindows(), std::vector{10});
    QTest::keyClick(&screen, Qt::Key_M);
    QCOMPARE(screen.time_s(), windows[30].time_s);
    QTest::keyClick(&screen, Qt::Key_M);
    QCOMPARE(screen.time_s(), windows[30].time_s);
    QTest::keyClick(&screen, Qt::Key_M, Qt::ShiftModifier);
    QCOMPARE(screen.time_s(), windows[10].time_s);
    // A row that is selected moves the cursor, and stays selected.
    auto& table = *screen.findChild<QTreeView*>("windows");
    QSignalSpy selected(&screen, &DetectionScreen::timeSelected);
    const QModelIndex row = table.indexBelow(table.currentIndex());
    QTest::mouseClick(table.viewport(), Qt::LeftButton, {},
                      table.visualRect(row.siblingAtColumn(2)).center());
    QCOMPARE(selected.count(), 1);
    QCOMPARE(screen.time_s(), windows[11].time_s);
    QCOMPARE(screen.windowList().selectedWindows(), std::vector{11});
    QTest::keyClick(&screen, Qt::Key_W);
    QVERIFY(!screen.windowList().isVisible());
  }

  void list_standsBesideLayersWhereThereIsRoom() {
    DetectionScreen screen;
    screen.show();
    screen.setSession(recorded_->session);
    const auto layers = [&] { return screen.findChild<QCheckBox*>()->isVisible(); };
    const auto below = [&](const QWidget& upper, const QWidget& lower) {
      return lower.mapTo(&screen, QPoint()).y() >= upper.mapTo(&screen, QPoint(0, upper.height())).y();
    };
    screen.resize(1680, 950);
    QVERIFY(screen.windowList().isVisible() && layers());
    QTRY_VERIFY(!below(screen.windowList(), screen.panel()));
    screen.resize(1030, 650);
    QVERIFY(!screen.windowList().isVisible() && layers());
    screen.setWindowsListed(true);
    QVERIFY(screen.windowList().isVisible() && !layers() && screen.panel().isVisible());
    QTRY_VERIFY(below(screen.windowList(), screen.panel()) && screen.panel().height() > 90);
    QTRY_VERIFY(screen.view().width() > 500);
    screen.resize(760, 600);
    QTRY_VERIFY(screen.windowList().isVisible() && screen.view().width() > 300);
  }

  void pictures() {
    auto run = recorded_->run();
    for (std::size_t k = 0; k < run->detections.cameras[0].views.size(); ++k) {
      run->result.circle_residuals.push_back(
          residualOf(static_cast<int>(k), 0, 0.02 + 0.001 * static_cast<double>(k % 17)));
    }
    for (const bool dark : {false, true}) {
      applyTheme(*qApp, dark ? Appearance::Dark : Appearance::Light);
      DetectionScreen screen;
      screen.show();
      screen.setSession(recorded_->session);
      screen.setRun(run, recorded_->session);
      const std::vector<BoardView>& views = run->detections.cameras[0].views;
      screen.setRejections(RejectedTimes{{views[22].time_s, views[24].time_s}});
      screen.setWindowsListed(true);
      for (const QSize& size : {QSize(770, 620), QSize(1028, 720), QSize(1660, 980)}) {
        screen.resize(size);
        screen.setTime(recorded_->goodWindow().time_s);
        settle(screen);
        // In a narrow page the list shares its height with the verdict.
        QTRY_VERIFY_WITH_TIMEOUT(screen.windowList().pictures().count() > (size.width() < 1350 ? 2 : 5),
                                 20'000 * kSlowdown);
        QTest::qWait(300);
        QVERIFY(screen.grab().save(
            screenshotPath("window_list_%1_%2.png").arg(dark ? "dark" : "light").arg(size.width())));
      }
    }
    applyTheme(*qApp, Appearance::Light);
  }
};

EVICAL_TEST(TestWindowList)
#include "tst_window_list.moc"
