// SPDX-License-Identifier: GPL-3.0-or-later
// Data that users take from the window: rows, poses, drawings, charts and tables.
#include "core/export/pose_text.h"
#include "core/numerics/angles.h"
#include "tests/support/file_content.h"
#include "tests/support/own_result.h"
#include "tests/support/test_program.h"
#include "tests/ui/plot_hands.h"
#include "tests/ui/screenshots.h"
#include "ui/plots/chart_saving.h"
#include "ui/scene/trajectory_track.h"
#include "ui/screens/result/correlation_view.h"
#include "ui/screens/result/observability_view.h"
#include "ui/screens/result/pose_panel.h"
#include "ui/screens/result/quantity_table.h"
#include "ui/screens/result/result_screen.h"
#include "ui/screens/result/rig_drawing.h"
#include "ui/theme/theme.h"

#include <QClipboard>
#include <QComboBox>
#include <QFile>
#include <QHeaderView>
#include <QImage>
#include <QLabel>
#include <QMenu>
#include <QMessageBox>
#include <QSignalSpy>
#include <QTabWidget>
#include <QTemporaryDir>
#include <QToolButton>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

namespace {

NamedResult stereoRig() {
  NamedResult named;
  named.reference = "imu";
  named.cameras = {{"left"}, {"right"}};
  named.imus = {{"imu"}};
  CalibrationResult result;
  result.state.imus.resize(1);
  for (const double x_m : {0.03, -0.07}) {
    CameraState camera;
    camera.reference_from_camera.rotation =
        Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()));
    camera.reference_from_camera.translation_m = {x_m, 0.0, 0.04};
    camera.time_offset_s = 0.0071;
    result.state.cameras.push_back(camera);
  }
  result.cameras.resize(2);
  result.imus.resize(1);
  result.uncertainty.cameras.resize(2);
  for (CameraUncertainty& sigma : result.uncertainty.cameras) {
    sigma.rotation_std_rad.setConstant(1e-4);
    sigma.translation_std_m.setConstant(1e-4);
    sigma.time_offset_std_s = 1e-5;
  }
  result.uncertainty.columns = {{QuantityOwner::Camera, 0, QuantityId::Translation, 0},
                                {QuantityOwner::Camera, 0, QuantityId::Translation, 1},
                                {QuantityOwner::Camera, 0, QuantityId::TimeOffset}};
  result.uncertainty.correlation = Eigen::MatrixXd::Identity(3, 3);
  result.uncertainty.correlation(0, 2) = result.uncertainty.correlation(2, 0) = -0.9;
  result.uncertainty.observability = {0.25, 400.0};
  result.uncertainty.directions = {"translation along left's z axis", "time offset of left"};
  result.uncertainty.weakest = result.uncertainty.directions.front();
  named.result = std::make_shared<const CalibrationResult>(std::move(result));
  return named;
}

// Columns for all quantities of a stereo rig.
void nameEverything(UncertaintyReport& report) {
  report.columns.clear();
  for (const std::size_t camera : {0, 1}) {
    for (const QuantityId id : {QuantityId::Rotation, QuantityId::Translation})
      for (const std::size_t axis : {0, 1, 2})
        report.columns.push_back({QuantityOwner::Camera, camera, id, axis});
    report.columns.push_back({QuantityOwner::Camera, camera, QuantityId::TimeOffset});
  }
  for (const QuantityId bias : {QuantityId::GyroscopeBias, QuantityId::AccelerometerBias})
    for (const std::size_t axis : {0, 1, 2}) report.columns.push_back({QuantityOwner::Imu, 0, bias, axis});
  const auto count = static_cast<Eigen::Index>(report.columns.size());
  report.correlation = Eigen::MatrixXd::Identity(count, count);
  for (Eigen::Index row = 0; row < count; ++row)
    for (Eigen::Index col = 0; col < row; ++col)
      report.correlation(row, col) = report.correlation(col, row) =
          std::sin(static_cast<double>(7 * row + 3 * col)) * std::exp(-0.2 * static_cast<double>(row - col));
  report.observability.clear();
  report.directions.clear();
  for (int k = 0; k < 14; ++k) {
    report.observability.push_back(0.3 * std::pow(3.0, k));
    const char* const words = k % 2 == 0
                                  ? "translation along left's z axis together with time offset of right"
                                  : "rotation about right's x axis";
    report.directions.emplace_back(words);
  }
}

QString clipboard() {
  return QGuiApplication::clipboard()->text();
}

const SavedForm& formOf(const std::vector<SavedForm>& forms, const QString& suffix) {
  return *std::find_if(forms.begin(), forms.end(),
                       [&](const SavedForm& form) { return form.suffix == suffix; });
}

// Saved like by a user, without the question for the path.
QByteArray saved(const std::vector<SavedForm>& forms, const QString& suffix) {
  const QTemporaryDir folder;
  FileSaver saver(nullptr);
  QSignalSpy done(&saver, &FileSaver::saved);
  const QString path = folder.filePath("file." + suffix);
  saver.save(path, formOf(forms, suffix));
  return done.wait(20000) ? evical::test::fileContent(path) : QByteArray();
}

}  // namespace

class TestHandOn : public QObject {
  Q_OBJECT

  const NamedResult rig_ = stereoRig();

 private slots:
  void init() {
    applyTheme(*qApp, Appearance::Light);
    QGuiApplication::clipboard()->clear();
  }

  void selectedRows_areCopiedWhole() {
    QuantityTable table;
    table.setGroups(parameterGroups(rig_), false);
    QTreeWidgetItem* const left = table.topLevelItem(0);
    for (const int row : {3, 5}) left->child(row)->setSelected(true);
    QTest::keyClick(&table, Qt::Key_C, Qt::ControlModifier);
    const QStringList lines = clipboard().split('\n', Qt::SkipEmptyParts);
    QCOMPARE(lines.size(), 3);
    QCOMPARE(lines[0], QString("name\tvalue\tsigma\tunit"));
    for (const int row : {3, 5}) {
      QStringList cells = {"Camera left in imu: " + left->child(row)->text(0)};
      for (int column = 1; column < 4; ++column) cells << left->child(row)->text(column);
      QVERIFY2(lines.contains(cells.join('\t')), qPrintable(clipboard()));
    }
    table.clearSelection();
    left->setSelected(true);
    QCOMPARE(table.selectedText().count('\n'), left->childCount() + 1);
    QCOMPARE(table.allText().count("Camera right in imu: Translation x\t-70.00\t0.10\tmm\n"), 1);
  }

  void names_areWholeInANarrowWindow() {
    ResultScreen screen;
    screen.resize(760, 520);
    screen.setResult(rig_);
    screen.show();
    auto* const table = screen.findChild<QuantityTable*>();
    QTRY_VERIFY(table->viewport()->width() > 100);
    const QFontMetrics metrics(table->font());
    for (int i = 0; i < table->topLevelItemCount(); ++i)
      for (int k = 0; k < table->topLevelItem(i)->childCount(); ++k) {
        const QTreeWidgetItem* const item = table->topLevelItem(i)->child(k);
        QVERIFY2(metrics.horizontalAdvance(item->text(0)) + 2 * table->indentation() <= table->columnWidth(0),
                 qPrintable(item->text(0)));
      }
  }

  void pose_isShownInAllWays() {
    PosePanel panel;
    panel.setResult(rig_);
    panel.show();
    const auto visible = [&](const char* name) { return panel.findChild<QLabel*>(name)->isVisible(); };
    for (const char* const always : {"translation", "quaternion"}) QVERIFY(visible(always));
    for (const bool shown : {false, true}) {
      for (const char* const more : {"rotation_vector", "angles", "matrix"}) QCOMPARE(visible(more), shown);
      QTest::mouseClick(panel.findChild<QToolButton*>("more_rotations"), Qt::LeftButton);
    }
    const auto shown = [&](const char* name) { return panel.findChild<QLabel*>(name)->text().simplified(); };
    QCOMPARE(shown("direction"), QString("Transforms points of left to imu: p_imu = R p_left + t"));
    QCOMPARE(shown("translation"), QString("30.0000 0.0000 40.0000"));
    const Eigen::Quaterniond& q = rig_.result->state.cameras[0].reference_from_camera.rotation;
    QVERIFY(shown("quaternion").startsWith(QString::number(q.x(), 'f', 6)) &&
            shown("quaternion").endsWith(QString::number(q.w(), 'f', 6)));
    QVERIFY(shown("matrix").endsWith("0.000000 0.000000 0.000000 1.000000"));
    auto* const sensor = panel.findChild<QComboBox*>("posed_sensor");
    sensor->setCurrentIndex(1);
    emit sensor->activated(1);
    QCOMPARE(shown("translation"), QString("-70.0000 0.0000 40.0000"));
  }

  void copyAs_putsTheFormInTheClipboard() {
    ResultScreen screen;
    QVERIFY(!screen.copyMenu()->menuAction()->isEnabled());
    screen.setResult(rig_);
    QVERIFY(screen.copyMenu()->menuAction()->isEnabled());
    const std::vector<SensorPose> poses = sensorPoses(rig_);
    for (const PoseForm& form : poseForms()) {
      auto* const action = screen.copyMenu()->findChild<QAction*>(form.name, Qt::FindDirectChildrenOnly);
      QVERIFY2(action != nullptr && !action->toolTip().isEmpty(), form.name);
      action->trigger();
      QCOMPARE(clipboard().toStdString(), form.write(poses[0]));
      QVERIFY(screen.findChild<QLabel*>("copied")->text().contains(form.title));
    }
    const QMenu* const all = screen.copyMenu()->findChild<QMenu*>();
    all->findChild<QAction*>("yaml")->trigger();
    QCOMPARE(clipboard().toStdString(), poseText(poseForms()[1], poses));
    QCOMPARE(screen.findChild<QToolButton*>("copy_as")->menu(), screen.copyMenu());
  }

  void anglesAtGimbalLock_areSaidNotToBeUnique() {
    NamedResult locked = rig_;
    evical::test::ownResult(locked).state.cameras[0].reference_from_camera.rotation =
        Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()) *
        Eigen::AngleAxisd(kRadPerDeg * -89.8, Eigen::Vector3d::UnitY());
    PosePanel panel;
    panel.setResult(rig_);
    auto* const warning = panel.findChild<QLabel*>("angles_warning");
    QVERIFY(warning->isHidden());
    panel.setResult(locked);
    panel.show();
    QVERIFY(!warning->isVisible());  // like the angles
    panel.findChild<QToolButton*>("more_rotations")->click();
    QVERIFY(warning->isVisible());
    QCOMPARE(warning->text(), QString("Angles are not unique here: use the quaternion"));
    QuantityTable table;
    table.setGroups(parameterGroups(locked), false);
    const QList<QTreeWidgetItem*> pitch = table.findItems("Pitch", Qt::MatchExactly | Qt::MatchRecursive);
    QCOMPARE(pitch.size(), 1);  // of the other camera: there the angles mean nothing
    QVERIFY(pitch[0]->parent()->text(0).contains("right"));
  }

  void rig_isDrawnToScale_andTurns() {
    RigDrawing drawing;
    drawing.resize(420, 300);
    drawing.setResult(rig_);
    QCOMPARE(drawing.text(), QString("left is 50.0 mm from imu; right is 80.6 mm from imu"));
    const QImage before = drawing.grab().toImage();
    for (const QColor& axis : theme().axes) QVERIFY(pixelsLike(before, axis, before.rect()) > 20);
    QTest::keyClick(&drawing, Qt::Key_2);
    const QImage side = drawing.grab().toImage();
    QVERIFY(side != before);
    QTest::keyClick(&drawing, Qt::Key_Home);
    QCOMPARE(drawing.grab().toImage(), before);
    const QString svg = saved(pictureForms(&drawing), "svg");
    for (const char* const words : {"left", "imu (reference)", "50.0 mm", "80.6 mm"})
      QVERIFY2(svg.contains(words), words);
    QVERIFY(!svg.contains("<image"));
  }

  // Names and lengths, in the smallest size of the drawing, from all sides.
  void rig_hasNoTextOverAnother() {
    RigDrawing drawing;
    drawing.setResult(rig_);
    for (const QSize size : {drawing.minimumSizeHint(), QSize(250, 160), QSize(420, 300)}) {
      drawing.resize(size);
      for (const Qt::Key from : {Qt::Key_Home, Qt::Key_1, Qt::Key_2, Qt::Key_3}) {
        QTest::keyClick(&drawing, from);
        const std::vector<RigDrawing::Label> labels = drawing.labels(drawing.size());
        QVERIFY(labels.size() > 5);  // three names, two lengths, and letters
        for (const RigDrawing::Label& one : labels) {
          if (one.letter) continue;
          const QString what =
              QString("%1 at %2 x %3, key %4").arg(one.text).arg(size.width()).arg(size.height()).arg(from);
          QVERIFY2(QRectF(drawing.rect()).contains(one.place), qPrintable(what));
          for (const RigDrawing::Label& other : labels)
            QVERIFY2(&one == &other || !one.place.intersects(other.place),
                     qPrintable(what + " over " + other.text));
        }
      }
    }
  }

  void correlations_areNamedInWordsAndSaved() {
    CorrelationView view;
    view.resize(420, 420);
    view.setResult(rig_);
    QCOMPARE(view.axisLabels(), (QStringList{"left: translation", "left: time offset"}));
    QVERIFY(QString(saved(pictureForms(&view), "svg")).count("left: translation") == 2);  // rows and columns
    QVERIFY(view.csv().contains("left.time_offset [s],-0.9,0,1\n"));
  }

  void observability_namesItsBarsAndItsScale() {
    ObservabilityView view;
    view.resize(500, 300);
    view.setObservability({0.25, 400.0}, {"translation along left's z axis", "time offset of left"});
    const QString svg = saved(pictureForms(&view), "svg");
    for (const char* const words : {"time offset of left", "logarithmic", "20 x", "0.5 x"})
      QVERIFY2(svg.contains(words), words);
  }

  void chart_isSavedAsPictureDrawingAndTable() {
    PlotPanel panel(kTime);
    fillWithLine(panel);
    const std::vector<SavedForm> forms = panel.savedForms();
    const QImage picture = QImage::fromData(saved(forms, "png"));
    QCOMPARE(picture.width(), 2 * panel.findChild<QWidget*>()->width());
    QVERIFY(pixelsLike(picture, theme().accent, picture.rect()) > 200);
    const QString svg = saved(forms, "svg");
    QVERIFY(svg.contains("<svg") && svg.contains("Gyroscope") && svg.contains("time (s)"));
    QVERIFY(svg.contains("<polyline") || svg.contains("<path"));
    QVERIFY(saved(forms, "pdf").startsWith("%PDF"));
    QCOMPARE(QString(saved(forms, "csv")), panel.csv());
  }

  void cellsAndArrows_areInTheTable() {
    PlotPanel panel({.title = "Image", .x_label = "x (px)", .y_label = "y (px)"});
    panel.setCells({QRectF(0.0, 0.0, 20.0, 10.0), 2, 1, {3.0, std::numeric_limits<double>::quiet_NaN()}},
                   PlotColour::Accent);
    const PlotArrow arrow{{1.0, 2.0}, {3.0, 4.0}};
    panel.setArrows({&arrow, 1}, PlotColour::Text);
    QCOMPARE(panel.csv(), QString("series,x (px),y (px),value,to x,to y\ncell,5,5,3,,\narrow,1,2,,3,4\n"));
  }

  void pageOfCharts_isSavedAsOnePicture() {
    QWidget page;
    auto* const a = new PlotPanel({.title = "First"}, &page);
    auto* const b = new PlotPanel({.title = "Second"}, &page);
    auto* const hidden = new PlotPanel({.title = "Third"}, &page);
    a->setGeometry(0, 0, 300, 200);
    b->setGeometry(300, 0, 300, 200);
    hidden->hide();
    QToolButton* const button = makeSaveButton(page, "page");
    page.resize(600, 200);
    page.show();
    QVERIFY(QTest::qWaitForWindowExposed(&page));
    const QString svg = saved(PlotPanel::pictureForms({a, b}, page), "svg");
    QVERIFY(svg.contains("First") && svg.contains("Second"));
    emit button->menu()->aboutToShow();
    QStringList entries;
    for (const QAction* const action : button->menu()->actions()) entries << action->text();
    QVERIFY(entries.contains("First") && entries.contains("Second") && !entries.contains("Third"));
  }

  void folderThatIsNotThere_isSaid() {
    QWidget window;
    PlotPanel panel(kTime, &window);
    fillWithLine(panel);
    FileSaver saver(&window);
    QSignalSpy failed(&saver, &FileSaver::failed);
    saver.save("/no/such/folder/x.csv", formOf(panel.savedForms(), "csv"));
    QVERIFY(failed.wait(20000));
    const auto* const message = window.findChild<QMessageBox*>();
    QVERIFY(message && message->text().contains("/no/such/folder/x.csv"));
  }

  void trajectoryTable_hasALineASample() {
    TrajectoryTrack track;
    track.times_s = {0.0, 0.5};
    track.positions_m = {{0.1, 0.2, 0.3}, {1.0, 2.0, 3.0}};
    track.speeds_m_s = {0.25, 0.5};
    track.residuals_px = {0.125, std::numeric_limits<double>::quiet_NaN()};
    QCOMPARE(trackCsv(track), std::string("time_s,x_m,y_m,z_m,speed_m_s,residual_px\n"
                                          "0,0.1,0.2,0.3,0.25,0.125\n0.5,1,2,3,0.5,\n"));
  }

  // Sizes in windows of 1024x700, 1280x800 and 1920x1080.
  void screenshots() {
    NamedResult full = rig_;
    nameEverything(evical::test::ownResult(full).uncertainty);
    for (const Appearance appearance : {Appearance::Light, Appearance::Dark}) {
      applyTheme(*qApp, appearance);
      ResultScreen screen;
      screen.setResult(full);
      screen.show();
      auto* const tabs = screen.findChild<QTabWidget*>();
      for (const QSize size : {QSize(772, 580), QSize(1028, 680), QSize(1668, 960)}) {
        screen.resize(size);
        for (int tab = 0; tab < 3; ++tab) {
          tabs->setCurrentIndex(tab);
          QTest::qWait(50);
          QVERIFY(screen.grab().save(screenshotPath("hand_on_%1_%2_%3.png")
                                         .arg(tab)
                                         .arg(theme().dark ? "dark" : "light")
                                         .arg(size.width())));
        }
      }
    }
  }
};

EVICAL_TEST(TestHandOn)
#include "tst_hand_on.moc"
