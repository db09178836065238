// Frame cameras from the recording to the result, against the truth of simulated frames.
#include "core/numerics/angles.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/lens/intrinsics_calibration.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/session/session.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/synthetic/board_truth.h"
#include "core/synthetic/scenario_yaml.h"
#include "core/synthetic/sinusoid_motion.h"

#include "core/geometry/projection_difference.h"
#include "core/geometry/so3.h"

#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

namespace {

using namespace evical;

constexpr double kSimulatedFramesSigmas = 4.0;

// Ten frames per second in front of an AprilGrid, with a line delay of 30 us.
Scenario rollingShutter() {
  Scenario scenario = readScenario(test::scenarioPath("rolling_shutter"));
  scenario.duration_s = 8.0;
  scenario.cameras.front().frames->rate_hz = 10.0;
  return scenario;
}

}  // namespace

class TestSimulatedFrames : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase() {
    folder_ = std::make_unique<QTemporaryDir>();
    scenario_ = rollingShutter();
    scenario_.tag_print.quarter_turns =
        3;  // of the tags within their squares: the result does not depend on it
    simulate(scenario_, path(), RunContext{});
  }

  void tagsInJpegs_areFound_data() {
    QTest::addColumn<bool>("charuco");
    QTest::addColumn<int>("turns");
    for (const bool charuco : {true, false})
      for (int turns = charuco ? 0 : 1; turns < 4; ++turns)
        QTest::addRow("%s, tags rotated by %d deg", charuco ? "ChArUco" : "AprilGrid", 90 * turns)
            << charuco << turns;
  }

  // Corners are where the simulator's motion projects them, for all rotations of tags within their squares.
  void tagsInJpegs_areFound() {
    QFETCH(bool, charuco);
    QFETCH(int, turns);
    Scenario scenario = scenario_;
    scenario.duration_s = 2.0;
    scenario.tag_print.quarter_turns = turns;
    if (charuco) {
      scenario.board = {};
      scenario.board.type = BoardType::Charuco;
      scenario.board.rows = 7;
      scenario.board.cols = 10;
      scenario.board.spacing_m = 0.07;
      scenario.board.tag_size_m = 0.052;
      scenario.board.radius_m = 0.0;
    }
    scenario.cameras.front().frames->line_delay_us = 0.0;
    scenario.cameras.front().frames->jpeg_quality = 85;
    const QTemporaryDir folder;
    const SimulationSummary made = simulate(scenario, folder.path().toStdString(), RunContext{});
    const Session session = readSession(made.session);
    const DetectionResult detections = readAndDetect(session, givenLenses(session), RunContext{});
    const auto named = [&](const RecordingFault& fault) {
      return fault.text.find(turns == 2 ? "rotated by 180 deg within" : "rotated by 90 deg ") !=
             std::string::npos;
    };
    QCOMPARE(std::any_of(detections.faults.begin(), detections.faults.end(), named), turns > 0);
    const BoardObservations& seen = detections.cameras.front();
    QVERIFY2(seen.views.size() >= 18, QByteArray::number(static_cast<double>(seen.views.size())));
    const SinusoidMotion motion(scenario);
    double squares_px2 = 0.0;
    int corners = 0;
    for (const BoardView& view : seen.views) {
      const std::vector<TrueCircle> truth = trueBoardView(motion, scenario, 0, view.time_s);
      for (const CircleObservation& corner : view.circles) {
        const auto is = std::find_if(truth.begin(), truth.end(),
                                     [&](const TrueCircle& each) { return each.circle == corner.circle; });
        QVERIFY(is != truth.end());
        squares_px2 += (corner.centre_px - is->centre_px).squaredNorm();
        ++corners;
      }
    }
    QVERIFY2(corners > 600, QByteArray::number(corners));
    const double rms_px = std::sqrt(squares_px2 / corners);
    QVERIFY2(rms_px < 0.15, QByteArray::number(rms_px));
  }

  void rollingShutter_isCalibratedWithinItsSigmas() {
    const CalibrationRun run = calibrate(session(), RunContext{});
    const CameraState& camera = run.result.state.cameras.front();
    const CameraUncertainty& sigma = run.result.uncertainty.cameras.front();
    const SimulatedCamera& truth = scenario_.cameras.front();
    const Eigen::Vector3d turn =
        quaternionLog(camera.reference_from_camera.rotation * truth.imu_from_camera.rotation.conjugate());
    const Eigen::Vector3d shift =
        camera.reference_from_camera.translation_m - truth.imu_from_camera.translation_m;
    QVERIFY((turn.cwiseAbs().array() < kSimulatedFramesSigmas * sigma.rotation_std_rad.array()).all());
    QVERIFY((shift.cwiseAbs().array() < kSimulatedFramesSigmas * sigma.translation_std_m.array()).all());
    QVERIFY2(sigma.rotation_std_rad.maxCoeff() < 0.03 * kRadPerDeg,
             QByteArray::number(sigma.rotation_std_rad.maxCoeff() / kRadPerDeg));
    QVERIFY(sigma.translation_std_m.maxCoeff() < 3e-3);
    QVERIFY(std::abs(camera.time_offset_s - truth.time_offset_s) <
            kSimulatedFramesSigmas * sigma.time_offset_std_s);
    QVERIFY(std::abs(camera.line_delay_us - truth.frames->line_delay_us) <
            kSimulatedFramesSigmas * sigma.line_delay_std_us);
    QVERIFY2(std::abs(camera.line_delay_us - 30.0) < 0.3, QByteArray::number(camera.line_delay_us));
    // With 8 s a translation may be less certain than required, which must be the only reason.
    QVERIFY2(run.result.status == CalibrationStatus::Ok || run.result.reason.find("translation along") == 0,
             run.result.reason.c_str());
    const double seen = static_cast<double>(run.detections.cameras[0].views.size()) /
                        static_cast<double>(run.detections.cameras[0].windows.size());
    QVERIFY2(seen > 0.95, QByteArray::number(seen));
  }

  void shutterCalledGlobal_isEstimated_orDoubtful() {
    Session global = session();
    global.cameras.front().shutter = Shutter::Global;
    const CalibrationRun freed = calibrate(global, RunContext{});
    QCOMPARE(freed.result.freed.size(), std::size_t{1});
    QCOMPARE(freed.result.freed[0].repair->text(), std::string("optimisation.model.line_delay=true"));
    QVERIFY(std::abs(freed.result.state.cameras.front().line_delay_us - 30.0) < 0.3);
    global.options.optimisation.edit().line_delay = Estimated::No;
    const CalibrationRun run = calibrate(global, RunContext{});
    QVERIFY(run.result.status == CalibrationStatus::Doubtful);
    QVERIFY2(run.result.reason.find("shutter is rolling") != std::string::npos, run.result.reason.c_str());
  }

  // A rolling shutter slightly distorts the image, by the board's motion during the readout.
  void lensOfFrames_isFoundAlone() {
    const IntrinsicsRun run = calibrateIntrinsics(session(), 0, RunContext{});
    const double off_px =
        projectionDifference(scenario_.cameras.front().intrinsics, run.result.intrinsics).rms_px;
    QVERIFY2(off_px < 3.0, QByteArray::number(off_px));
    QCOMPARE(run.result.edge_localisation_bias_px, 0.0);
  }

  void picturesOfAnotherSize_areRefused() {
    Session other = session();
    other.cameras.front().intrinsics->resolution_px = {640, 480};
    other.cameras.front().resolution_px = {640, 480};
    QVERIFY_THROWS_EXCEPTION(CalibrationError, calibrate(other, RunContext{}));
  }

  void picturesWithoutTimes_areRefusedBesideAnImu() {
    const QTemporaryDir untimed;
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(path() / "frames" / "cam0"))
      std::filesystem::copy_file(entry.path(), std::filesystem::path(untimed.path().toStdString()) /
                                                   ("a" + std::to_string(++count) + ".png"));
    Session other = session();
    other.cameras.front().recording = untimed.path().toStdString();
    other.cameras.front().stream = "pictures";
    try {
      calibrate(other, RunContext{});
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      QVERIFY2(QString(error.what()).contains("have no times"), error.what());
    }
  }

  void damagedPictures_areSaid_andCostTheirViewsOnly() {
    int spoilt = 0;
    for (const auto& entry : std::filesystem::directory_iterator(path() / "frames" / "cam0")) {
      if (spoilt == 3) break;
      std::filesystem::resize_file(entry.path(), 1000);
      ++spoilt;
    }
    const CalibrationRun run = calibrate(session(), RunContext{});
    QVERIFY(std::any_of(run.detections.faults.begin(), run.detections.faults.end(),
                        [](const RecordingFault& fault) {
                          return fault.text.find("3 of 80 frames cannot be read") != std::string::npos;
                        }));
  }

 private:
  std::filesystem::path path() const { return folder_->path().toStdString(); }
  Session session() const { return readSession(path() / "session.yaml"); }

  std::unique_ptr<QTemporaryDir> folder_;
  Scenario scenario_;
};

EVICAL_TEST(TestSimulatedFrames)
#include "tst_simulated_frames.moc"
