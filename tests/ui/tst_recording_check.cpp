// SPDX-License-Identifier: GPL-3.0-or-later
// Automatic check of an opened recording: the page's report, which nothing else waits for.
#include "core/optimisation/optimisation_options.h"
#include "tests/support/test_program.h"
#include "tests/ui/other_load.h"
#include "tests/ui/simulated_session.h"
#include "tests/ui/window_fixture.h"
#include "ui/screens/recording/check_card.h"
#include "ui/screens/recording/recording_screen.h"
#include "ui/window/session_files.h"
#include "ui/window/steps_panel.h"

#include <QLabel>
#include <QPushButton>
#include <QToolButton>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

namespace {

struct CheckFixture : WindowFixture {
  RecordingCheckJob& check = window.workbench().check;
  QSignalSpy started{&check, &RecordingCheckJob::started}, checked{&check, &RecordingCheckJob::checkedAnew},
      interrupted{&check, &RecordingCheckJob::interrupted};

  CheckFixture() { check.setAutomatic(true); }
  CheckCard* card() { return child<RecordingScreen>()->checkCard(); }
  QString pageText() {
    QString all;
    for (const QLabel* const label : child<RecordingScreen>()->findChildren<QLabel*>())
      if (label->isVisibleTo(child<RecordingScreen>())) all += label->text() + '\n';
    return all;
  }
};

}  // namespace

class TestRecordingCheck : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

 private slots:
  void initTestCase() {
    usePrivateFolders(scratch_);
    simulatedSession();
  }
  void init() { QSettings().clear(); }

  void card_appearsByItself_andCalibrateStartsFromWhatWasDetected() {
    CheckFixture test;
    test.window.files().open(copyOfSimulatedSession(scratch_.path()));
    QVERIFY(test.card()->isVisible());  // it keeps its place before, during and after the check
    QTRY_COMPARE_WITH_TIMEOUT(test.checked.size(), 1, kPatience_ms);
    const QString text = test.card()->text();
    QVERIFY2(test.card()->isVisible() && text.contains("Record 20 to 30 s"), qPrintable(text));
    QVERIFY(!test.runner().running());
    QTest::mouseClick(test.child<QToolButton>("check_details"), Qt::LeftButton);
    const QString details = test.card()->text();
    for (const char* const said : {"Duration", "Board in view", "Coverage", "Angular rate", "Accelerations",
                                   "Expected uncertainty of the translation", "px/s", "s, required 15 s"})
      QVERIFY2(details.contains(said), qPrintable(details));
    QVERIFY(test.card()->findChildren<LightMark*>().size() > 8);
    QVERIFY2(test.pageText().contains("Ready to calibrate"), qPrintable(test.pageText()));

    QSignalSpy detecting(&test.window.workbench().calibration, &CalibrationJob::detecting);
    QSignalSpy stages(&test.runner(), &JobRunner::stageStarted);
    QString detect_step;
    connect(&test.runner(), &JobRunner::stageStarted, &test.window, [&](const QString& stage) {
      if (stage == "initialise") detect_step = test.child<StepsPanel>()->textOf("detect");
    });
    test.press(Qt::Key_F5);
    QVERIFY2(test.pageText().contains("Calibrating\n"), qPrintable(test.pageText()));
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QVERIFY2(detect_step.contains("done"), qPrintable(detect_step));
    QVERIFY2(test.pageText().contains("Calibrated\n"), qPrintable(test.pageText()));
    QCOMPARE(detecting.size(), 0);
    for (const QList<QVariant>& stage : stages) QVERIFY(stage.at(0).toString() != "detect");
    const auto run = test.document().last().run;
    QVERIFY(run && run->detections.detect_s > 0.0);
    QCOMPARE(run->detections.detect_s, test.check.checked()->detected->detections.detect_s);
    QCOMPARE(test.started.size(), 1);
    QVERIFY(!test.card()->isClear());  // the assessment stays
    QVERIFY(test.window.close());
  }

  // The card has a text in all states: its place would be an empty strip.
  void card_tellsWhyNothingIsChecked() {
    CheckFixture test;
    test.check.setAutomatic(false);
    test.window.files().open(copyOfSimulatedSession(scratch_.path()));
    QVERIFY2(test.card()->text().contains("not checked"), qPrintable(test.card()->text()));
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QVERIFY2(test.card()->text().contains("is calibrated"), qPrintable(test.card()->text()));
    // An edit starts a check; the card does not flash before.
    test.check.setAutomatic(true);
    Session other = test.document().session();
    other.time_range_s = {{0.0, 0.5}};
    test.document().edit(other, "Cut");
    QVERIFY2(test.card()->text().contains("Checking"), qPrintable(test.card()->text()));
    QTRY_COMPARE_WITH_TIMEOUT(test.checked.size(), 1, kPatience_ms);
    other.time_range_s = {{0.0, 0.6}};
    test.document().edit(other, "Cut");
    QVERIFY2(test.card()->text().contains("Checking"), qPrintable(test.card()->text()));
    test.check.setAutomatic(false);
    QVERIFY2(test.card()->text().contains("not checked"), qPrintable(test.card()->text()));
    answerQuestion(QMessageBox::Discard);
    QVERIFY(test.window.close());
  }

  void whatIsExpected_isWhatTheCalibrationFinds() {
    CheckFixture test;
    test.window.files().open(copyOfSimulatedSession(scratch_.path()));
    QTRY_COMPARE_WITH_TIMEOUT(test.checked.size(), 1, kPatience_ms);
    const ExpectedSigmas expected = test.check.checked()->assessment.sigmas.at(0);
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    const double found_mm =
        1e3 * test.document().last().run->result.uncertainty.cameras.at(0).translation_std_m.maxCoeff();
    QVERIFY(expected.translation_mm < 1.5 * found_mm && found_mm < 1.5 * expected.translation_mm);
    QVERIFY(test.window.close());
  }

  void calibrate_doesNotWaitForTheCheck() {
    CheckFixture test;
    test.window.files().open(copyOfSimulatedSession(scratch_.path()));
    QTRY_VERIFY_WITH_TIMEOUT(test.check.running(), kPatience_ms);
    const ComputedTime since;
    test.press(Qt::Key_F5);
    QVERIFY(test.runner().running());
    QCOMPARE(test.interrupted.size(), 1);
    QTRY_VERIFY_WITH_TIMEOUT(!test.check.running(), 5000 * kSlowdown);
    QVERIFY(since.elapsed_ms() < 2000.0 * slowness());
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    spin(2000);  // the result has more information: nothing starts again
    QVERIFY(!test.check.running());
    QCOMPARE(test.checked.size(), 0);
    QVERIFY(test.window.close());
  }

  void anotherSession_endsTheCheckOfTheOldOne() {
    CheckFixture test;
    test.window.files().open(copyOfSimulatedSession(scratch_.path()));
    QTRY_VERIFY_WITH_TIMEOUT(test.check.running(), kPatience_ms);
    Session other = test.document().session();
    other.time_range_s = {{0.0, 0.5}};
    test.document().edit(other, "Cut");
    QTRY_COMPARE_WITH_TIMEOUT(test.checked.size(), 1, kPatience_ms);
    const RecordingAssessment& assessment = test.check.checked()->assessment;
    QVERIFY(!assessment.can_be_calibrated);
    QVERIFY2(test.pageText().contains("Not ready"), qPrintable(test.pageText()));
    QVERIFY2(test.card()->text().contains("too short"),
             qPrintable(test.card()->text()));  // the obstacle first
    QVERIFY(!test.pageText().contains("Ready to calibrate"));
    answerQuestion(QMessageBox::Discard);
    QVERIFY(test.window.close());
  }

  void laterStages_areNoReasonToDetectAgain() {
    CheckFixture test;
    test.window.files().open(copyOfSimulatedSession(scratch_.path()));
    QTRY_COMPARE_WITH_TIMEOUT(test.checked.size(), 1, kPatience_ms);
    const double detect_s = test.check.checked()->detected->detections.detect_s;
    Session stricter = test.document().session();
    stricter.options.optimisation.edit().needed_translation_mm = 0.01;
    test.document().edit(stricter, "Need more");
    QTRY_COMPARE_WITH_TIMEOUT(test.checked.size(), 2, kPatience_ms);
    QCOMPARE(test.check.checked()->detected->detections.detect_s, detect_s);
    QCOMPARE(test.check.checked()->assessment.light, Light::Poor);
    QVERIFY2(test.card()->text().contains("not good enough"), qPrintable(test.card()->text()));
    answerQuestion(QMessageBox::Discard);
    QVERIFY(test.window.close());
  }

  void guessedBoard_isNotReadyUntilSomebodyConfirmsIt() {
    CheckFixture test;
    test.check.setAutomatic(false);
    const Session recorded = readSession(simulatedSession().toStdString());
    test.window.files().open(QString::fromStdString(recorded.recording.string()));
    QTRY_VERIFY_WITH_TIMEOUT(test.document().hasSession(), kPatience_ms);
    QVERIFY2(test.pageText().contains("11 x 4, 50 mm, not confirmed"), qPrintable(test.pageText()));
    QVERIFY(!test.pageText().contains("Ready to calibrate"));
    auto* const confirm = test.child<QPushButton>("confirm_board");
    QVERIFY(confirm->isVisible());
    QTest::mouseClick(confirm, Qt::LeftButton);
    QVERIFY2(test.pageText().contains("Ready to calibrate"), qPrintable(test.pageText()));
    QVERIFY(!confirm->isVisible());
    QVERIFY(test.window.close());
  }

  // For a single camera, neither the sensors' distance nor the IMU's motion is required.
  void cameraAlone_isJudgedWithoutTheRig() {
    CheckFixture test;
    test.window.workbench().lens.setAim(CalibrationAim::Camera);
    test.window.files().open(copyOfSimulatedSession(scratch_.path()));
    QTRY_COMPARE_WITH_TIMEOUT(test.checked.size(), 1, kPatience_ms);
    const RecordingAssessment& assessment = test.check.checked()->assessment;
    QVERIFY(assessment.can_be_calibrated && assessment.light != Light::Poor);
    for (const Assessed& one : assessment.all)
      QVERIFY2(one.thing != AssessedThing::Translation && one.thing != AssessedThing::Turns &&
                   one.thing != AssessedThing::Obstacle,
               nameOf(one.thing));
    QVERIFY2(!test.card()->text().contains("distance between the sensors"), qPrintable(test.card()->text()));
    // The rig is checked again.
    test.window.workbench().lens.setAim(CalibrationAim::Rig);
    QTRY_COMPARE_WITH_TIMEOUT(test.checked.size(), 2, kPatience_ms);
    QVERIFY(!test.check.checked()->assessment.sigmas.empty());
    QVERIFY(test.window.close());
  }

  void lights_areToldByShapeToo() {
    std::vector<QImage> shapes;
    for (const Light light : {Light::Good, Light::Fair, Light::Poor}) {
      LightMark mark;
      mark.setLight(light);
      // Areas that are painted, in any colour.
      QImage shape = mark.grab().toImage().convertToFormat(QImage::Format_RGB32);
      const QRgb ground = shape.pixel(0, 0);
      for (int y = 0; y < shape.height(); ++y)
        for (int x = 0; x < shape.width(); ++x)
          shape.setPixel(x, y, shape.pixel(x, y) == ground ? 0xffffffff : 0xff000000);
      for (const QImage& other : shapes) QVERIFY(shape != other);
      shapes.push_back(shape);
      QVERIFY(!mark.accessibleName().isEmpty());
    }
  }
};

EVICAL_TEST(TestRecordingCheck)
#include "tst_recording_check.moc"
