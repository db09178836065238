#include "core/initialisation/initialise.h"

#include "core/base/error.h"
#include "core/geometry/so3.h"
#include "tests/core/initialisation/simulated_input.h"
#include "tests/support/test_program.h"

#include <QRegularExpression>

#include <algorithm>
#include <functional>

using namespace evical;
using namespace evical::test;

namespace {

using Change = std::function<void(SimulationOptions&)>;

QString describeForInitialise(const InitialErrors& e) {
  return QString("rotation %1 deg, translation %2 mm, offset %3 ms, gravity %4 deg")
      .arg(e.rotation_deg)
      .arg(e.translation_m * 1e3)
      .arg(e.time_offset_s * 1e3)
      .arg(e.gravity_deg);
}

std::string failureOf(const CalibrationInput& input, const InitialisationOptions& options = {}) {
  try {
    initialise(input, options, RunContext{});
  } catch (const CalibrationError& error) {
    return error.what();
  }
  return {};
}

bool mentions(const std::vector<std::string>& texts, const char* part) {
  return std::any_of(texts.begin(), texts.end(),
                     [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

SimulationOptions shortRecording() {
  SimulationOptions simulation;
  simulation.duration_s = 8.0;
  return simulation;
}

}  // namespace

class TestInitialise : public QObject {
  Q_OBJECT

 private slots:
  // Transforms the samples into those of an aligned gyroscope.
  void knownGyroscopeRotation_isTurnedBack() {
    SimulationOptions simulation = shortRecording();
    simulation.second_imu = true;
    SimulatedInput simulated = simulateInput(simulation);
    const Initialisation straight = initialise(simulated.input, {}, RunContext{});
    const Eigen::Quaterniond turn = quaternionExp({0.1, -0.14, 0.03});
    for (ImuData& imu : simulated.input.imus) {
      for (ImuSample& sample : imu.samples) sample.angular_rate_rad_s = turn * sample.angular_rate_rad_s;
      imu.prior.gyroscope_rotation = KnownRotation{turn, Eigen::Vector3d::Constant(0.01)};
    }
    const Initialisation turned = initialise(simulated.input, {}, RunContext{});
    const CameraState &a = straight.state.cameras[0], &b = turned.state.cameras[0];
    QVERIFY(rotationAngleBetween_rad(a.reference_from_camera.rotation, b.reference_from_camera.rotation) <
            1e-6);
    QVERIFY(std::abs(a.time_offset_s - b.time_offset_s) < 1e-7);
    for (std::size_t k = 0; k < 2; ++k) {
      const ImuState &before = straight.state.imus[k], &after = turned.state.imus[k];
      QVERIFY(after.gyroscope_from_accelerometer.coeffs() == turn.coeffs());
      QVERIFY((after.gyroscope_bias_rad_s - turn * before.gyroscope_bias_rad_s).norm() < 1e-6);
    }
  }

  void givenValues_areTaken() {
    SimulationOptions simulation = shortRecording();
    simulation.second_imu = true;
    SimulatedInput simulated = simulateInput(simulation);
    const Initialisation free = initialise(simulated.input, {}, RunContext{});
    const CameraState& found = free.state.cameras[0];
    const Eigen::Quaterniond rotation =
        quaternionExp({1e-3, 0.0, 0.0}) * found.reference_from_camera.rotation;
    simulated.input.cameras[0].prior.rotation = KnownRotation{rotation};
    simulated.input.cameras[0].prior.time_offset = KnownNumber{0.0095};
    simulated.input.cameras[0].prior.translation =
        KnownVector{found.reference_from_camera.translation_m + Eigen::Vector3d(1e-3, 0.0, 0.0)};
    simulated.input.imus[1].prior.time_offset = KnownNumber{0.0295};
    const Initialisation held = initialise(simulated.input, {}, RunContext{});
    const CameraState& camera = held.state.cameras[0];
    QVERIFY(camera.reference_from_camera.rotation.coeffs() == rotation.coeffs());
    QCOMPARE(camera.time_offset_s, 0.0095);
    const Eigen::Vector3d moved_m =
        camera.reference_from_camera.translation_m - found.reference_from_camera.translation_m;
    QVERIFY2((moved_m - Eigen::Vector3d(1e-3, 0.0, 0.0)).norm() < 2e-4,
             qPrintable(QString::number(moved_m.x())));
    QCOMPARE(held.state.imus[1].time_offset_s, 0.0295);
  }

  void givenTimeOffsetThatIsWrong_isWarnedOf() {
    SimulatedInput simulated = simulateInput(shortRecording());
    simulated.input.cameras[0].prior.time_offset = KnownNumber{0.6};
    const Initialisation initial = initialise(simulated.input, {}, RunContext{});
    QVERIFY(mentions(initial.warnings, "given time offset of 0.6000 s"));
  }

  // Accurate enough that the batch converges.
  void initialise_recoversTruth_data() {
    QTest::addColumn<Change>("change");
    QTest::addColumn<double>("search_s");
    const auto row = [](const char* name, Change change, double search_s = 1.0) {
      QTest::newRow(name) << change << search_s;
    };
    row("offset -0.95 s", [](auto& s) { s.time_offset_s = -0.95; });
    row("offset -0.4 s", [](auto& s) { s.time_offset_s = -0.4; });
    row("offset 0.01 s", [](auto&) {});
    row("offset 0.4 s", [](auto& s) { s.time_offset_s = 0.4; });
    row("offset 0.9 s", [](auto& s) { s.time_offset_s = 0.9; });
    row(
        "offset -9 s within 60 s", [](auto& s) { s.time_offset_s = -9.0; }, 60.0);
    row("40 % missing", [](auto& s) { s.missing_share = 0.4; });
    row("5 % misplaced, 40 % missing", [](auto& s) { s.missing_share = 0.4, s.misplaced_share = 0.05; });
    row("200 Hz", [](auto& s) { s.imu_rate_hz = 200.0; });
    row("slow", [](auto& s) { s.motion = Motion::Slow, s.duration_s = 30.0; });
    row("fast", [](auto& s) { s.motion = Motion::Fast; });
    row("periodic", [](auto& s) { s.motion = Motion::Periodic, s.time_offset_s = 0.3; });
    row("coarse centres", [](auto& s) { s.centre_sigma_px = 0.5; });
    row("IMU covers the middle third", [](auto& s) { s.imu_begin_s = 6.0, s.imu_end_s = 12.0; });
    row("5 s", [](auto& s) { s.duration_s = 5.0; });
  }
  void initialise_recoversTruth() {
    QFETCH(Change, change);
    QFETCH(double, search_s);
    SimulationOptions simulation;
    simulation.duration_s = 18.0;
    change(simulation);
    const SimulatedInput simulated = simulateInput(simulation);
    InitialisationOptions options;
    options.time_offset_search_s = search_s;
    const Initialisation found = initialise(simulated.input, options, RunContext{});
    const InitialErrors errors = initialErrors(found.state, simulated);
    const QString text = describeForInitialise(errors);
    QVERIFY2(errors.rotation_deg < 0.5, qPrintable(text));
    QVERIFY2(errors.translation_m < 0.02, qPrintable(text));
    QVERIFY2(errors.time_offset_s < 2e-3, qPrintable(text));
    QVERIFY2(errors.gravity_deg < 1.0, qPrintable(text));
    QVERIFY(errors.trajectory_position_m < 0.02);
    QVERIFY(errors.trajectory_rotation_deg < 0.5);
    QVERIFY(errors.gyroscope_bias_rad_s < 5e-3);
    QVERIFY(found.steps.size() >= 5);
  }

  void initialise_giveSplinesOneRange() {
    SimulationOptions simulation = shortRecording();
    simulation.time_offset_s = -0.4;
    const SimulatedInput simulated = simulateInput(simulation);
    const CalibrationState state = initialise(simulated.input, {}, RunContext{}).state;
    QCOMPARE(state.imu_in_world_m.start_s, state.world_from_imu_rotation.start_s);
    QCOMPARE(state.imu_in_world_m.knot_spacing_s, state.world_from_imu_rotation.knot_spacing_s);
    QCOMPARE(state.imu_in_world_m.control_points.size(), state.world_from_imu_rotation.control_points.size());
    // Views reach from 0 to 8 s of the camera, -0.4 to 7.6 s of the IMU, which begins at 0.
    QVERIFY(std::abs(state.imu_in_world_m.start_s) < 1e-3);
    QVERIFY(state.imu_in_world_m.endTime_s() > 7.6 + 0.1);
    QVERIFY(state.imu_in_world_m.endTime_s() < 8.0);
  }

  void initialise_withTwoCameras_findsBoth() {
    SimulationOptions simulation = shortRecording();
    simulation.cameras = 2;
    const SimulatedInput simulated = simulateInput(simulation);
    const Initialisation found = initialise(simulated.input, {}, RunContext{});
    QCOMPARE(found.state.cameras.size(), std::size_t{2});
    for (const std::size_t camera : {0, 1}) {
      const InitialErrors errors = initialErrors(found.state, simulated, camera);
      QVERIFY2(errors.rotation_deg < 0.5 && errors.translation_m < 0.02 && errors.time_offset_s < 2e-3,
               qPrintable(describeForInitialise(errors)));
    }
  }

  void initialise_withWrongSpacing_saysSo_data() {
    QTest::addColumn<double>("given");
    QTest::addColumn<QString>("says");
    QTest::newRow("right") << 1.0 << QString();
    QTest::newRow("10 % too small") << 1.0 / 1.1
                                    << "seems (9|10|11) % larger than specified \\(spacing 0.04545 m\\)";
    QTest::newRow("10 % too large") << 1.0 / 0.9
                                    << "seems (9|10|11) % smaller than specified \\(spacing 0.05556 m\\)";
  }
  void initialise_withWrongSpacing_saysSo() {
    QFETCH(double, given);
    QFETCH(QString, says);
    SimulatedInput simulated = simulateInput(shortRecording());
    simulated.input.board.spacing_m *= given;
    simulated.input.board.radius_m *= given;
    const Initialisation found = initialise(simulated.input, {}, RunContext{});
    const QString doubt = QString::fromStdString(found.doubt);
    QCOMPARE(doubt.isEmpty(), says.isEmpty());
    QVERIFY2(doubt.contains(QRegularExpression(says)), qPrintable(doubt));
    QCOMPARE(mentions(found.warnings, "measure it"), !says.isEmpty());
  }

  void initialise_onOneAxis_warnsAndFindsRotation_data() {
    QTest::addColumn<int>("motion");
    QTest::newRow("one axis") << static_cast<int>(Motion::OneAxis);
    QTest::newRow("planar") << static_cast<int>(Motion::Planar);
  }
  void initialise_onOneAxis_warnsAndFindsRotation() {
    QFETCH(int, motion);
    SimulationOptions simulation;
    simulation.duration_s = 15.0;
    simulation.motion = static_cast<Motion>(motion);
    const SimulatedInput simulated = simulateInput(simulation);
    const Initialisation found = initialise(simulated.input, {}, RunContext{});
    QVERIFY(mentions(found.warnings, "one axis only: rotate about two more"));
    const InitialErrors errors = initialErrors(found.state, simulated);
    QVERIFY2(errors.rotation_deg < 2.0, qPrintable(describeForInitialise(errors)));
    QVERIFY2(errors.translation_m < 0.6, qPrintable(describeForInitialise(errors)));
    QVERIFY(errors.time_offset_s < 2e-3);
  }

  void initialise_onPeriodicMotion_saysAmbiguous() {
    SimulationOptions simulation = shortRecording();
    simulation.motion = Motion::Periodic;
    const Initialisation found = initialise(simulateInput(simulation).input, {}, RunContext{});
    QVERIFY(mentions(found.warnings, "nearly repeats itself"));
  }

  void initialise_onMisplacedViews_countsThem() {
    SimulationOptions simulation = shortRecording();
    simulation.misplaced_share = 0.05;
    const SimulatedInput simulated = simulateInput(simulation);
    QVERIFY(simulated.misplaced > 5);
    const Initialisation found = initialise(simulated.input, {}, RunContext{});
    QVERIFY(mentions(found.warnings, (std::to_string(simulated.misplaced) + " of ").c_str()));
  }

  void initialise_onImuGap_warns() {
    SimulatedInput simulated = simulateInput(shortRecording());
    auto& samples = simulated.input.imus[0].samples;
    samples.erase(samples.begin() + 3000, samples.begin() + 3300);
    const Initialisation found = initialise(simulated.input, {}, RunContext{});
    QVERIFY(mentions(found.warnings, "no samples for 0.3"));
    QVERIFY(initialErrors(found.state, simulated).rotation_deg < 0.5);
  }

  void initialise_isRefused_data() {
    QTest::addColumn<std::function<void(CalibrationInput&)>>("spoil");
    QTest::addColumn<QString>("reason");
    const auto row = [](const char* name, std::function<void(CalibrationInput&)> spoil, const char* reason) {
      QTest::newRow(name) << spoil << QString(reason);
    };
    row(
        "no camera", [](auto& input) { input.cameras.clear(); }, "there is no camera");
    row(
        "no intrinsics", [](auto& input) { input.cameras[0].lens = {}; }, "has no intrinsics");
    row(
        "no IMU", [](auto& input) { input.imus.clear(); }, "neither an IMU nor a second camera");
    row(
        "another recording's IMU",
        [](auto& input) {
          SimulationOptions other = shortRecording();
          other.seed = 5;
          input.imus.push_back(simulateInput(other).input.imus[0]);
        },
        "rotation rates do not agree");
    row(
        "no samples", [](auto& input) { input.imus[0].samples.clear(); }, "has only 0 usable samples");
    row(
        "ambiguous board", [](auto& input) { input.board.rows = 10; }, "half a turn");
    row(
        "few views", [](auto& input) { input.cameras[0].observations.views.resize(6); },
        "was detected in 6 of");
    row(
        "wrong focal length and board",
        [](auto& input) {
          input.cameras[0].lens.detection_intrinsics->distortion[0] = 0.0;
          for (BoardView& view : input.cameras[0].observations.views)
            for (CircleObservation& circle : view.circles) circle.circle = 43 - circle.circle * 7 % 44;
        },
        "points fit the board in");
    row(
        "IMU at rest",
        [](auto& input) {
          for (ImuSample& sample : input.imus[0].samples) sample.angular_rate_rad_s = {0.02, 0.0, 0.0};
        },
        "is at rest while left turns");
    row(
        "IMU an hour later",
        [](auto& input) {
          for (ImuSample& sample : input.imus[0].samples) sample.time_ns += 3'600'000'000'000;
        },
        "do not overlap in time: the board is seen from 0.010 s to 7.990 s");
    row(
        "IMU 62 s later",
        [](auto& input) {
          for (ImuSample& sample : input.imus[0].samples) sample.time_ns += 62'000'000'000;
        },
        "their rotations agree if the IMU's clock is 62.0");
    row(
        "IMU since 1970",
        [](auto& input) {
          for (ImuSample& sample : input.imus[0].samples) sample.time_ns += 1'700'000'000'000'000'000;
        },
        "Add -1700000000.0");
    row(
        "IMU of another recording, 70 s earlier",
        [](auto& input) {
          SimulationOptions other = shortRecording();
          other.seed = 5;
          input.imus[0] = simulateInput(other).input.imus[0];
          for (ImuSample& sample : input.imus[0].samples) sample.time_ns -= 70'000'000'000;
        },
        "if both recordings began at the same moment, add 70.");
    row(
        "too short", [](auto& input) { input.cameras[0].observations.views.resize(100); }, "overlap");
  }
  void initialise_isRefused() {
    QFETCH(std::function<void(CalibrationInput&)>, spoil);
    QFETCH(QString, reason);
    SimulatedInput simulated = simulateInput(shortRecording());
    spoil(simulated.input);
    const std::string failure = failureOf(simulated.input);
    QVERIFY2(failure.find(reason.toStdString()) != std::string::npos, failure.c_str());
  }

  void initialise_stopsWhenAsked() {
    const SimulatedInput simulated = simulateInput(shortRecording());
    std::stop_source source;
    source.request_stop();
    QVERIFY_THROWS_EXCEPTION(
        Cancelled, initialise(simulated.input, {}, RunContext{silentProgress(), source.get_token()}));
  }
};

EVICAL_TEST(TestInitialise)
#include "tst_initialise.moc"
