// SPDX-License-Identifier: GPL-3.0-or-later
// Complete workflows by mouse and keyboard, from an empty window to exported files: one user has a DAVIS and
// a printer, another one has two event cameras with a file each. A meter reports the longest stall of the
// window. Also run under Xvfb with a window manager.
#include "tests/support/test_program.h"
#include "tests/ui/other_load.h"
#include "tests/ui/simulated_session.h"
#include "tests/ui/slowdown.h"
#include "tests/ui/stall_meter.h"
#include "tests/ui/window_fixture.h"
#include "ui/detection/detection_screen.h"
#include "ui/detection/event_view.h"
#include "ui/detection/window_list.h"
#include "ui/detection/window_list_model.h"
#include "ui/document/printed_board.h"
#include "ui/screens/board/print_board_dialog.h"
#include "ui/screens/recording/check_card.h"
#include "ui/screens/recording/recording_screen.h"
#include "ui/screens/recording/stream_table.h"
#include "ui/screens/result/result_screen.h"
#include "ui/window/error_panel.h"
#include "ui/window/session_files.h"

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QTreeView>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

namespace {

void press(QPushButton* button) {
  QVERIFY(button && button->isVisible() && button->isEnabled());
  QTest::mouseClick(button, Qt::LeftButton);
}

// Values that users know from data sheets, typed at once.
void describeSensors(CalibrationDocument& document, const Session& known) {
  Session session = document.session();
  for (std::size_t k = 0; k < session.cameras.size(); ++k)
    session.cameras[k].intrinsics = known.cameras.at(k).intrinsics;
  for (SessionImu& imu : session.imus) imu.noise = known.imus.front().noise;
  document.edit(session, "Describe the sensors");
}

}  // namespace

class TestStories : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

 private slots:
  void initTestCase() {
    usePrivateFolders(scratch_);
    QVERIFY(QFile::exists(simulatedFurtherSession(1)));
    QVERIFY(QFile::exists(simulatedTwoCameraSession()));
  }
  void init() { QSettings().clear(); }

  void davis_fromBoardToExport() {
    WindowFixture test;
    StallMeter meter;
    const OtherLoad others;
    const Session known = readSession(simulatedFurtherSession(1).toStdString());
    printBoard(test, known.board);
    openRecording(test, QString::fromStdString(known.recording.string()));
    QVERIFY(std::abs(test.document().session().board.spacing_m - known.board.spacing_m) < 1e-9);
    Session session = test.document().session();
    session.board.radius_m = known.board.radius_m;
    test.document().edit(session, "The circles' radius");
    test.document().confirmBoard();
    describeSensors(test.document(), known);
    looksThroughIt(test);
    calibrate(test);
    const auto first = test.document().last().run;
    rejectsAWindow(test);
    test.press(Qt::Key_Z, Qt::ControlModifier);
    QVERIFY(test.document().last().run == first || test.document().rejectionsArePending());
    exportAll(test, "davis", {"openvins", "ros"}, "Kalibr, OpenVINS");
    save(test, "davis.yaml");
    stoodStill(meter, others);
    QVERIFY(test.window.close());
    reopen("davis");
  }

  void stereo_fromTwoFilesToExport() {
    WindowFixture test;
    StallMeter meter;
    const OtherLoad others;
    const Session known = readSession(simulatedTwoCameraSession().toStdString());
    openRecording(test, QString::fromStdString(known.recording.string()));
    QVERIFY(test.document().session().cameras.size() == 1);
    addTheOtherCamera(test, QString::fromStdString(known.cameras[1].recording.string()));
    Session session = test.document().session();
    session.board = known.board;
    test.document().edit(session, "The board");
    test.document().confirmBoard();
    describeSensors(test.document(), known);
    looksThroughIt(test);
    calibrate(test);
    seesBothCameras(test);
    comparesPoses(test, known);
    exportAll(test, "stereo", {"openvins", "basalt"}, "OpenVINS");
    save(test, "stereo.yaml");
    stoodStill(meter, others);
    QVERIFY(test.window.close());
    reopen("stereo");
  }

 private:
  void addTheOtherCamera(WindowFixture& test, const QString& recording) {
    answerFileDialog(recording);
    press(test.child<QPushButton>("add_recording"));
    auto* const streams = test.child<StreamTable>();
    QTRY_COMPARE_WITH_TIMEOUT(streams->rowCount(), 3, kPatience_ms);  // events and IMU of the first, events
    QComboBox* role = nullptr;
    for (QComboBox* const box : streams->findChildren<QComboBox*>())
      if (box->isVisible() && box->currentData().toInt() == static_cast<int>(StreamRole::Ignore)) role = box;
    QVERIFY(role != nullptr);
    role->setFocus();
    QTest::keyClick(role, Qt::Key_Down);
    emit role->activated(role->currentIndex());
    QCOMPARE(test.document().session().cameras.size(), std::size_t{2});
    QVERIFY(test.document().session().cameras[1].recording == recording.toStdString());
  }
  // One next to the other, at one time.
  void seesBothCameras(WindowFixture& test) {
    test.window.showScreen("detection");
    auto* const detection = test.child<DetectionScreen>();
    auto* const pictures = detection->findChild<QComboBox*>("picture_choice");
    QVERIFY(pictures != nullptr && pictures->isVisible());
    pictures->setFocus();
    while (pictures->currentIndex() + 1 < pictures->count() && !detection->companionView().isVisible())
      QTest::keyClick(pictures, Qt::Key_Down);
    QTRY_VERIFY_WITH_TIMEOUT(detection->companionView().isVisible() && detection->companionView().frame() &&
                                 detection->companionView().frame()->events > 100,
                             kPatience_ms);
  }
  // Both cameras, mounted 0.1 m from each other.
  static void comparesPoses(WindowFixture& test, const Session& known) {
    const auto& cameras = test.document().last().run->result.state.cameras;
    QCOMPARE(cameras.size(), known.cameras.size());
    const RigidTransform left_from_right =
        inverse(cameras[0].reference_from_camera) * cameras[1].reference_from_camera;
    QVERIFY((left_from_right.translation_m - Eigen::Vector3d(0.1, 0.0, 0.0)).norm() < 2e-3);
    QVERIFY(left_from_right.rotation.angularDistance(Eigen::Quaterniond::Identity()) < 2e-3);
  }
  void printBoard(WindowFixture& test, const Board& board) {
    QTest::mouseClick(test.child<QPushButton>("print_board_button"), Qt::LeftButton);
    auto* const dialog = test.child<PrintBoardDialog>();
    QVERIFY(dialog != nullptr && dialog->isVisible());
    QTest::mouseClick(dialog->findChild<QToolButton*>("after_printing"), Qt::LeftButton);
    dialog->findChild<QCheckBox*>("is_measured")->click();
    type(dialog->findChild<QLineEdit*>("measured_length"), QString::number(1e3 * 10 * board.spacing_m));
    QTest::mouseClick(dialog->findChild<QPushButton*>("take_board"), Qt::LeftButton);
    QVERIFY(lastPrintedBoard().has_value());
    if (dialog->isVisible()) dialog->close();
  }
  void openRecording(WindowFixture& test, const QString& recording) {
    test.window.workbench().check.setAutomatic(true);
    answerFileDialog(recording);
    test.press(Qt::Key_O, Qt::ControlModifier | Qt::ShiftModifier);
    QTRY_VERIFY_WITH_TIMEOUT(test.document().hasSession(), kPatience_ms);
    QCOMPARE(test.screen(), QString("recording"));
  }
  void looksThroughIt(WindowFixture& test) {
    RecordingCheckJob& check = test.window.workbench().check;
    QTRY_VERIFY_WITH_TIMEOUT(check.checked() != nullptr && !check.running(), kPatience_ms);
    auto* const card = test.child<RecordingScreen>()->checkCard();
    QVERIFY2(card->isVisible() && check.checked()->assessment.can_be_calibrated, qPrintable(card->text()));
  }
  // Goes to the result's page.
  void calibrate(WindowFixture& test) {
    test.press(Qt::Key_F5);
    QVERIFY2(test.runner().running(), qPrintable(test.child<ErrorPanel>()->text()));
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QTRY_COMPARE_WITH_TIMEOUT(test.screen(), QString("result"), kPatience_ms);
    const auto run = test.document().last().run;
    QVERIFY(run && run->result.status != CalibrationStatus::Failed);
    // No time was chosen: one with the board is shown, not the recording's last.
    auto* const detection = test.child<DetectionScreen>();
    const auto& windows = run->detections.cameras.front().windows;
    QTRY_VERIFY(std::any_of(windows.begin(), windows.end(), [&](const WindowReport& window) {
      return std::abs(window.time_s - detection->time_s()) < 1e-9 && window.outcome <= WindowOutcome::Partial;
    }));
    const double end_s = windows.back().time_s;
    QVERIFY(detection->time_s() > 0.25 * end_s && detection->time_s() < 0.75 * end_s);
  }
  void rejectsAWindow(WindowFixture& test) {
    test.window.showScreen("detection");
    auto& list = test.child<DetectionScreen>()->windowList();
    if (!list.isVisible()) test.press(Qt::Key_W);
    QTRY_VERIFY_WITH_TIMEOUT(list.isVisible() && list.model().rowCount() > 0, kPatience_ms);
    auto* const table = test.child<QTreeView>("windows");
    const QModelIndex row = table->model()->index(20, WindowListModel::State);
    table->scrollTo(row);
    QTest::mouseClick(table->viewport(), Qt::LeftButton, {}, table->visualRect(row).center());
    table->setFocus();
    QTest::keyClick(table, Qt::Key_Delete);
    QVERIFY(test.document().rejectionsArePending());
    test.finished.clear();
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QTRY_COMPARE(test.document().last().run->result.rejected_windows.size(), std::size_t{1});
  }
  void exportAll(WindowFixture& test, const QString& name, const QStringList& targets, const QString& said) {
    test.window.showScreen("result");
    test.finished.clear();
    answerExportDialog(targets, scratch_.filePath(name));
    press(test.child<QPushButton>("export"));
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    const auto* const notice = test.child<ExportNotice>();
    QVERIFY2(notice->isVisible() && notice->text().contains(said), qPrintable(notice->text()));
    for (const QString& target : targets)
      QVERIFY2(!QDir(scratch_.filePath(name + "/" + target)).isEmpty(), qPrintable(target));
  }
  void save(WindowFixture& test, const QString& name) {
    answerFileDialog(scratch_.filePath(name));
    test.press(Qt::Key_S, Qt::ControlModifier | Qt::ShiftModifier);
    QVERIFY(QFile::exists(scratch_.filePath(name)));
    QVERIFY(!test.window.isWindowModified());
  }
  void reopen(const QString& name) {
    WindowFixture test;
    test.window.files().open(scratch_.filePath(name));
    QTRY_VERIFY_WITH_TIMEOUT(test.document().last().run != nullptr, kPatience_ms);
    QTRY_COMPARE(test.screen(), QString("result"));
    for (const QString& page : test.window.screenNames()) {
      test.window.showScreen(page);
      spin(50);
    }
    QVERIFY(test.window.close());
  }
  static void stoodStill(const StallMeter& meter, const OtherLoad& others) {
    constexpr double kMax_ms = 250.0;  // limit of an immediate response, including dialogs and page layout
    const double longest_ms = others.quiet() ? meter.longest_ms() : meter.longestWork_ms();
    qInfo("longest stall of the window: %.0f ms (%.0f ms of work); others keep %.1f processors busy",
          meter.longest_ms(), meter.longestWork_ms(), others.processors());
    QVERIFY(meter.beats() > 100);
    QVERIFY2(longest_ms < kMax_ms * slowness(), qPrintable(QString::number(longest_ms)));
  }
};

EVICAL_TEST(TestStories)
#include "tst_stories.moc"
