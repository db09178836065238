// Assessment of a recording before its calibration: lights and advice that match it, and sigmas that the
// calibration confirms.
#include "core/pipeline/rig/recording_assessment.h"

#include "core/base/error.h"
#include "core/frontend/detection_options.h"
#include "core/numerics/angles.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/scenario_session.h"
#include "tests/support/simulated_pass.h"
#include "tests/support/simulated_recording.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>

using namespace evical;
using namespace evical::test;

namespace {

Scenario scenario(const QString& name, double duration_s) {
  Scenario read = readScenario(test::scenarioPath(name.toStdString()));
  read.duration_s = duration_s;
  return read;
}

const Assessed* find(const RecordingAssessment& assessment, AssessedThing thing) {
  const auto found = std::find_if(assessment.all.begin(), assessment.all.end(),
                                  [&](const Assessed& one) { return one.thing == thing; });
  return found == assessment.all.end() ? nullptr : &*found;
}

QString textOf(const RecordingAssessment& assessment) {
  QString text;
  for (const Assessed& one : assessment.all)
    text += QString("%1 %2: %3, required %4 (%5) %6\n")
                .arg(QString::fromStdString(one.sensor), nameOf(one.thing),
                     QString::fromStdString(one.measured), QString::fromStdString(one.required))
                .arg(static_cast<int>(one.light))
                .arg(QString::fromStdString(one.advice));
  return text;
}

Light lightOf(const RecordingAssessment& assessment, AssessedThing thing) {
  const Assessed* const found = find(assessment, thing);
  return found == nullptr ? Light::Good : found->light;
}

QString adviceOf(const RecordingAssessment& assessment, AssessedThing thing) {
  const Assessed* const found = find(assessment, thing);
  return found == nullptr ? QString() : QString::fromStdString(found->advice);
}

// Circles of an ideal front end.
RecordingAssessment assess(const QString& name, double duration_s) {
  SimulatedPass simulated = simulatePass(duration_s, scenario(name, duration_s));
  // It lists each window twice, in two consecutive lists.
  for (BoardObservations& camera : simulated.detections.cameras) {
    const auto later = [](const WindowReport& one, const WindowReport& next) {
      return next.time_s < one.time_s;
    };
    const auto end = std::adjacent_find(camera.windows.begin(), camera.windows.end(), later);
    if (end != camera.windows.end()) camera.windows.erase(std::next(end), camera.windows.end());
  }
  return assessRecording(simulated.session, {simulated.detections, {}}, {});
}

}  // namespace

class TestRecordingAssessment : public QObject {
  Q_OBJECT

 private slots:
  void sigmas_areThoseOfTheCalibration_data() {
    QTest::addColumn<QString>("name");
    QTest::addColumn<double>("duration_s");
    QTest::addColumn<bool>("events");
    QTest::newRow("everyday") << "davis346" << 6.0 << true;
    QTest::newRow("everyday, short") << "davis346" << 4.0 << false;
    QTest::newRow("slow") << "slow" << 10.0 << true;
    QTest::newRow("slow, perfect circles") << "slow" << 15.0 << false;
    QTest::newRow("fast") << "fast" << 6.0 << false;
    QTest::newRow("one axis") << "one_axis_rotation" << 10.0 << false;
    QTest::newRow("planar") << "planar_motion" << 10.0 << false;
    QTest::newRow("noisy") << "noisy" << 8.0 << false;
    QTest::newRow("two cameras, two IMUs") << "stereo_two_imus" << 6.0 << false;
  }
  void sigmas_areThoseOfTheCalibration() {
    QFETCH(QString, name);
    QFETCH(double, duration_s);
    QFETCH(bool, events);
    const Scenario truth = scenario(name, duration_s);
    const SimulatedPass perfect = events ? SimulatedPass{} : simulatePass(duration_s, truth);
    const Session session = sessionFor(truth);
    const DetectionResult detections = events ? detectedPass(truth, session) : perfect.detections;
    const RecordingAssessment assessment = assessRecording(session, {detections, {}}, {});
    const CalibrationRun run = calibrate(session, detections, {});
    QCOMPARE(assessment.sigmas.size(), truth.cameras.size());
    const auto agree = [&](double expected, double found, const char* what) {
      QVERIFY2(expected < 1.5 * found && found < 1.5 * expected,
               qPrintable(QString("%1: %2 expected, %3 found").arg(what).arg(expected).arg(found)));
    };
    for (std::size_t k = 0; k < assessment.sigmas.size(); ++k) {
      const CameraUncertainty& found = run.result.uncertainty.cameras[k];
      agree(assessment.sigmas[k].rotation_deg, kDegPerRad * found.rotation_std_rad.maxCoeff(), "rotation");
      agree(assessment.sigmas[k].translation_mm, 1e3 * found.translation_std_m.maxCoeff(), "translation");
      agree(assessment.sigmas[k].time_offset_ms, 1e3 * found.time_offset_std_s, "time offset");
    }
  }

  void goodRecording_hasGoodLightsOnly() {
    const RecordingAssessment assessment = assess("davis346", 20.0);
    for (const Assessed& one : assessment.all)
      QVERIFY2(one.light == Light::Good && one.advice.empty() && !one.required.empty(),
               qPrintable(textOf(assessment)));
    QCOMPARE(find(assessment, AssessedThing::Speed)->required, std::string("40 to 600 px/s"));
    QCOMPARE(find(assessment, AssessedThing::Rotation)->required, std::string("0.1 deg"));
    QCOMPARE(assessment.light, Light::Good);
    QVERIFY(assessment.can_be_calibrated && assessment.board_seen);
  }

  void oneAxis_isToldWhichTurnIsMissing() {
    const RecordingAssessment assessment = assess("one_axis_rotation", 20.0);
    QVERIFY(assessment.light != Light::Good);
    QCOMPARE(lightOf(assessment, AssessedThing::Turns), Light::Poor);
    QVERIFY(lightOf(assessment, AssessedThing::Translation) != Light::Good);
    QVERIFY2(adviceOf(assessment, AssessedThing::Turns).contains("Turn the camera"),
             qPrintable(textOf(assessment)));
    QVERIFY(adviceOf(assessment, AssessedThing::Translation).contains("translation along"));
  }

  void slowRecording_isToldToMoveFaster() {
    const RecordingAssessment assessment = assess("slow", 20.0);
    QVERIFY(lightOf(assessment, AssessedThing::Speed) != Light::Good);
    QVERIFY(adviceOf(assessment, AssessedThing::Speed).startsWith("Move faster"));
    QVERIFY(assessment.light != Light::Good);
  }

  void twoSeconds_areTooShort() {
    const RecordingAssessment assessment = assess("davis346", 2.0);
    QCOMPARE(lightOf(assessment, AssessedThing::Duration), Light::Poor);
    QCOMPARE(find(assessment, AssessedThing::Duration)->required, std::string("15 s"));
    QVERIFY(adviceOf(assessment, AssessedThing::Duration).contains("20 to 30 s"));
    QCOMPARE(assessment.light, Light::Poor);
    QVERIFY(!assessment.can_be_calibrated);
  }

  void recordingWithoutTheBoard_saysSoAndNothingElseIsInTheWay() {
    SimulatedPass simulated = simulatePass(10.0);
    BoardObservations& seen = simulated.detections.cameras.front();
    seen.views.clear();
    for (WindowReport& window : seen.windows) {
      window.outcome = WindowOutcome::TooFewCircles;
      window.circles = 0;
    }
    const RecordingAssessment assessment = assessRecording(simulated.session, {simulated.detections, {}}, {});
    QCOMPARE(lightOf(assessment, AssessedThing::Board), Light::Poor);
    QVERIFY(adviceOf(assessment, AssessedThing::Board).contains("board"));
    QVERIFY(!assessment.board_seen && !assessment.can_be_calibrated);
    QVERIFY(assessment.sigmas.empty() && find(assessment, AssessedThing::Obstacle) == nullptr);
    QCOMPARE(assessment.light, Light::Poor);
    // The motion is reported nevertheless.
    QVERIFY(find(assessment, AssessedThing::Turns) != nullptr);
  }

  void accelerationsInG_areAnObstacleThatIsNamed() {
    SimulatedPass simulated = simulatePass(6.0);
    for (ImuSample& sample : simulated.detections.imus.front().samples) sample.specific_force_m_s2 /= 9.81;
    const RecordingAssessment assessment = assessRecording(simulated.session, {simulated.detections, {}}, {});
    const Assessed* const obstacle = find(assessment, AssessedThing::Obstacle);
    QVERIFY2(obstacle != nullptr && obstacle->measured.find("seems to be g") != std::string::npos,
             qPrintable(textOf(assessment)));
    QVERIFY(!assessment.can_be_calibrated);
  }

  void recording_isCheckedWithTheLensFoundFirst_andCalibratedFromThat() {
    Session session = readSession(test::simulatedRecording("davis346", 4.0));
    session.cameras.front().intrinsics.reset();
    const CheckedRecording checked = checkRecording(session, {});
    QVERIFY(checked.detected && checked.assessment.can_be_calibrated);
    QVERIFY2(find(checked.assessment, AssessedThing::Lens) != nullptr,
             qPrintable(textOf(checked.assessment)));

    Session noisier = session;
    noisier.imus.front().noise.gyroscope_density *= 2.0;
    QVERIFY(detectsTheSame(session, noisier));
    const DetectedRecording detected = forSession(*checked.detected, noisier);
    const CalibrationRun from_check = calibrate(noisier, detected.detections, {}, detected.intrinsics);
    const CalibrationRun from_recording = calibrate(noisier, {});
    const auto at = [](const CalibrationRun& run) {
      return run.result.state.cameras.front().reference_from_camera.translation_m;
    };
    QVERIFY((at(from_check) - at(from_recording)).norm() < 1e-9);
    QCOMPARE(from_check.result.notes.size(), from_recording.result.notes.size());
  }

  void whatIsDetected_dependsOnBoardLensAndRangeOnly() {
    const Session session = simulatePass(4.0).session;
    const auto changed = [&](auto&& change) {
      Session other = session;
      change(other);
      return detectsTheSame(session, other);
    };
    QVERIFY(changed([](Session& other) { other.options.optimisation.edit().needed_rotation_deg = 1.0; }));
    QVERIFY(changed([](Session& other) { other.exports = {"openvins"}; }));
    QVERIFY(changed([](Session& other) {
      other.cameras.front().name = "other";
      other.reference = other.imus.front().name = "another";
    }));
    QVERIFY(!changed([](Session& other) { other.board.rows = 9; }));
    QVERIFY(!changed([](Session& other) { other.time_range_s = {1.0, 2.0}; }));
    QVERIFY(!changed([](Session& other) { other.cameras.front().intrinsics.reset(); }));
    QVERIFY(!changed([](Session& other) { other.options.front_end.edit().grid.min_circles += 1; }));
    QVERIFY(!changed([](Session& other) { other.imus.front().stream = "/other"; }));
  }

  void checking_stopsWhenAskedTo() {
    const SimulatedPass simulated = simulatePass(10.0);
    std::stop_source stop;
    stop.request_stop();
    QVERIFY_THROWS_EXCEPTION(Cancelled, assessRecording(simulated.session, {simulated.detections, {}},
                                                        {silentProgress(), stop.get_token()}));
  }
};

EVICAL_TEST(TestRecordingAssessment)
#include "tst_recording_assessment.moc"
