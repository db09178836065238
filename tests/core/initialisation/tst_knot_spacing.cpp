#include "core/initialisation/knot_spacing.h"

#include "core/base/error.h"
#include "core/data/unfit_samples.h"
#include "core/initialisation/initialise.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/synthetic/imu_simulator.h"
#include "tests/core/initialisation/simulated_input.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

using namespace evical;
using namespace evical::test;

namespace {

using Samples = std::vector<ImuSample>;
using Spoil = std::function<void(Samples&)>;

ImuData imuIn(Motion motion, double rate_hz = 1000.0) {
  SimulationOptions simulation;
  simulation.duration_s = 10.0;
  simulation.motion = motion;
  simulation.imu_rate_hz = rate_hz;
  simulation.window_s = 0.5;  // few views of the board
  return simulateInput(simulation).input.imus.front();
}

KnotSpacing spacingOf(const ImuData& imu, const ViewPrecision& views = {}) {
  const std::int64_t start_ns = imu.samples.front().time_ns;
  const GyroRotation rotation(withoutRateSpikes(imu.samples), start_ns);
  return knotSpacing(imu, start_ns, {rotation.begin_s(), rotation.end_s()}, rotation, views);
}

// At rest, with the given noise times a factor.
ImuData imuAtRest(double noise = 1.0, double rate_hz = 1000.0) {
  constexpr double kDuration_s = 20.0;
  ImuData imu;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const auto draw = [&] {
    const double x = normal(random), y = normal(random), z = normal(random);
    return Eigen::Vector3d(noise * std::sqrt(rate_hz) * Eigen::Vector3d(x, y, z));
  };
  for (int k = 0; k < static_cast<int>(kDuration_s * rate_hz); ++k) {
    ImuSample& sample = imu.samples.emplace_back();
    sample.time_ns = static_cast<std::int64_t>(std::llround(1e9 * k / rate_hz));
    sample.angular_rate_rad_s = imu.noise.gyroscope_density * draw();
    sample.specific_force_m_s2 = Eigen::Vector3d(0.0, -9.81, 0.0) + imu.noise.accelerometer_density * draw();
  }
  return imu;
}

// Low-pass filter like that of a sensor.
void smooth(Samples& samples) {
  constexpr std::size_t kTaps = 5;
  const Samples raw = samples;
  for (std::size_t i = kTaps; i < samples.size(); ++i) {
    samples[i].angular_rate_rad_s.setZero();
    samples[i].specific_force_m_s2.setZero();
    for (std::size_t k = 0; k < kTaps; ++k) {
      samples[i].angular_rate_rad_s += raw[i - k].angular_rate_rad_s / kTaps;
      samples[i].specific_force_m_s2 += raw[i - k].specific_force_m_s2 / kTaps;
    }
  }
}

// Error of the batch that starts from the initialisation.
NoiseScales scalesAfterBatch(const CalibrationInput& input, double knot_spacing_s) {
  InitialisationOptions options;
  options.knot_spacing_s = knot_spacing_s;
  const Initialisation initial = initialise(input, options, RunContext{});
  return optimiseBatch(input, initial.state, {}, RunContext{}).scales;
}

QString describeForKnotSpacing(const KnotSpacing& found) {
  return QString::fromStdString(describe("imu", found, found.spacing_s()));
}

}  // namespace

class TestKnotSpacing : public QObject {
  Q_OBJECT

 private slots:
  void spacing_followsTheMotion_data() {
    QTest::addColumn<int>("motion");
    QTest::addColumn<double>("min_ms");
    QTest::addColumn<double>("max_ms");
    const auto row = [](const char* name, Motion motion, double min_ms, double max_ms) {
      QTest::newRow(name) << static_cast<int>(motion) << min_ms << max_ms;
    };
    row("hardly moving", Motion::HardlyMoving, 60.0, 100.0);
    row("slow", Motion::Slow, 50.0, 100.0);
    row("everyday", Motion::Everyday, 40.0, 85.0);
    row("fast", Motion::Fast, 8.0, 20.0);
    row("shaky", Motion::Shaky, 2.4, 8.0);
  }
  void spacing_followsTheMotion() {
    QFETCH(int, motion);
    QFETCH(double, min_ms);
    QFETCH(double, max_ms);
    const ViewPrecision views{2e-5, 1.5e-5};  // 0.03 px, and forty circles per view
    const KnotSpacing found = spacingOf(imuIn(static_cast<Motion>(motion)), views);
    const double spacing_ms = 1e3 * found.spacing_s();
    QVERIFY2(spacing_ms >= min_ms && spacing_ms <= max_ms, qPrintable(describeForKnotSpacing(found)));
    // Accelerations are splines of a lower degree, which follow less closely.
    QVERIFY2(found.rates.spacing_s >= found.accelerations.spacing_s,
             qPrintable(describeForKnotSpacing(found)));
    for (const KnotDemand& demand : {found.rates, found.accelerations})
      QVERIFY2(demand.missed <= 0.5 * demand.noise, qPrintable(describeForKnotSpacing(found)));
  }

  void noise_isWhatItIs() {
    const ImuData imu = imuIn(Motion::Fast);
    const KnotSpacing found = spacingOf(imu);
    QVERIFY2(std::abs(found.rates.noise / (imu.noise.gyroscope_density * std::sqrt(1000.0)) - 1.0) < 0.05,
             qPrintable(describeForKnotSpacing(found)));
    QVERIFY2(std::abs(found.accelerations.noise / (imu.noise.accelerometer_density * std::sqrt(1000.0)) -
                      1.0) < 0.1,
             qPrintable(describeForKnotSpacing(found)));
  }

  void noiseAlone_asksForNothing_data() {
    QTest::addColumn<ImuData>("imu");
    QTest::newRow("as given") << imuAtRest();
    QTest::newRow("ten times more") << imuAtRest(10.0);
    QTest::newRow("ten times less") << imuAtRest(0.1);
    QTest::newRow("200 Hz") << imuAtRest(1.0, 200.0);
    ImuData filtered = imuAtRest();
    smooth(filtered.samples);
    QTest::newRow("filtered") << filtered;
  }
  void noiseAlone_asksForNothing() {
    QFETCH(ImuData, imu);
    QVERIFY2(spacingOf(imu).spacing_s() == kWidestKnots_s,
             qPrintable(describeForKnotSpacing(spacingOf(imu))));
    // Nor if views are so accurate that the noise hides their information.
    const ViewPrecision views{1e-6, 1e-6};
    QVERIFY2(spacingOf(imu, views).spacing_s() > kUsualKnot_s,
             qPrintable(describeForKnotSpacing(spacingOf(imu, views))));
  }

  // Views add less than a poor IMU's noise would hide.
  void views_askForCloserKnots() {
    ImuData imu = imuIn(Motion::Fast);
    std::mt19937_64 random(4);
    std::normal_distribution<double> normal(0.0, 1.0);
    for (ImuSample& sample : imu.samples)
      for (int axis = 0; axis < 3; ++axis) sample.specific_force_m_s2[axis] += normal(random);
    const KnotSpacing alone = spacingOf(imu), seen = spacingOf(imu, {2e-5, 1.5e-5});
    QVERIFY2(seen.accelerations.spacing_s < 0.8 * alone.accelerations.spacing_s,
             qPrintable(describeForKnotSpacing(seen)));
  }

  void oddSamples_changeNothing_data() {
    QTest::addColumn<Spoil>("spoil");
    QTest::newRow("spikes") << Spoil([](Samples& samples) {
      std::mt19937 random(7);
      for (int k = 0; k < 50; ++k) {
        ImuSample& sample = samples[100 + random() % (samples.size() - 200)];
        sample.angular_rate_rad_s += Eigen::Vector3d(30.0, -20.0, 10.0);
        sample.specific_force_m_s2 += Eigen::Vector3d(-100.0, 150.0, 50.0);
      }
    });
    QTest::newRow("a knock") << Spoil([](Samples& samples) {
      for (std::size_t k = 0; k < 30; ++k) {
        const double fading =
            std::exp(-0.1 * static_cast<double>(k)) * std::sin(1.5 * static_cast<double>(k));
        samples[5100 + k].angular_rate_rad_s += fading * Eigen::Vector3d(3.0, 2.0, 1.0);
        samples[5100 + k].specific_force_m_s2 += fading * Eigen::Vector3d(80.0, 50.0, 20.0);
      }
    });
    QTest::newRow("a gap") << Spoil(
        [](Samples& samples) { samples.erase(samples.begin() + 3000, samples.begin() + 3300); });
    QTest::newRow("a limit") << Spoil([](Samples& samples) {
      for (ImuSample& sample : samples)
        sample.angular_rate_rad_s = sample.angular_rate_rad_s.cwiseMax(-1.2).cwiseMin(1.2);
    });
  }
  void oddSamples_changeNothing() {
    QFETCH(Spoil, spoil);
    ImuData imu = imuIn(Motion::Everyday);
    const double whole_s = spacingOf(imu).spacing_s();
    spoil(imu.samples);
    const KnotSpacing found = spacingOf(imu);
    QVERIFY2(std::abs(found.spacing_s() / whole_s - 1.0) < 0.2, qPrintable(describeForKnotSpacing(found)));
  }

  void knots_areNoCloserThanSamples_data() {
    QTest::addColumn<double>("rate_hz");
    for (const double rate_hz : {100.0, 200.0, 400.0, 1000.0})
      QTest::newRow(qPrintable(QString("%1 Hz").arg(rate_hz))) << rate_hz;
  }
  void knots_areNoCloserThanSamples() {
    QFETCH(double, rate_hz);
    const KnotSpacing found = spacingOf(imuIn(Motion::Shaky, rate_hz));
    QVERIFY2(found.spacing_s() >= 2.5 / rate_hz - 1e-9 && found.spacing_s() >= kClosestKnots_s,
             qPrintable(describeForKnotSpacing(found)));
    QVERIFY2(found.spacing_s() <= 4.0 / rate_hz + 3e-3, qPrintable(describeForKnotSpacing(found)));
  }

  // A noise density with a wide margin is common practice, and not a measure of the motion.
  void densitiesTenTimesTooLarge_changeLittle() {
    ImuData imu = imuIn(Motion::Shaky);
    const double right_s = spacingOf(imu).spacing_s();
    imu.noise.gyroscope_density *= 10.0;
    imu.noise.accelerometer_density *= 10.0;
    const KnotSpacing found = spacingOf(imu);
    QVERIFY2(found.spacing_s() < 2.5 * right_s, qPrintable(describeForKnotSpacing(found)));
  }

  void shakyHands_areFollowedByTheBatch() {
    SimulationOptions simulation;
    simulation.duration_s = 6.0;
    simulation.motion = Motion::Shaky;
    const CalibrationInput input = simulateInput(simulation).input;
    const double fixed = scalesAfterBatch(input, 0.02).accelerometers[0];
    QVERIFY2(fixed > 4.0, qPrintable(QString::number(fixed)));
    const double followed = scalesAfterBatch(input, 0.0).accelerometers[0];
    // With 2.5 samples per knot interval, splines absorb 40 % of the noise's variance.
    QVERIFY2(followed > 0.7 && followed < 1.3, qPrintable(QString::number(followed)));
  }

  // In the gap only views constrain closely spaced knots: the rest of the recording gives the same result as
  // without the gap.
  void shakyHandsWithAGap_areSolved() {
    SimulationOptions simulation;
    simulation.duration_s = 6.0;
    simulation.motion = Motion::Shaky;
    CalibrationInput input = simulateInput(simulation).input;
    const auto solve = [&] {
      return optimiseBatch(input, initialise(input, {}, RunContext{}).state, {}, RunContext{});
    };
    const BatchSolution whole = solve();
    Samples& samples = input.imus[0].samples;
    samples.erase(samples.begin() + 3000, samples.begin() + 3200);
    const BatchSolution solution = solve();
    QVERIFY(solution.converged);
    const CameraState &camera = solution.state.cameras[0], &other = whole.state.cameras[0];
    const double moved_m =
        (camera.reference_from_camera.translation_m - other.reference_from_camera.translation_m).norm();
    QVERIFY2(moved_m < 1e-3, qPrintable(QString::number(moved_m)));
    QVERIFY(rotationAngleBetween_rad(camera.reference_from_camera.rotation,
                                     other.reference_from_camera.rotation) < 5e-4);
    QVERIFY(std::abs(camera.time_offset_s - other.time_offset_s) < 2e-5);
  }

  void givenSpacing_isTaken() {
    SimulationOptions simulation;
    simulation.duration_s = 6.0;
    const CalibrationInput input = simulateInput(simulation).input;
    InitialisationOptions options;
    options.knot_spacing_s = 0.033;
    const Initialisation initial = initialise(input, options, RunContext{});
    QCOMPARE(initial.state.world_from_imu_rotation.knot_spacing_s, 0.033);
    QCOMPARE(initial.state.imu_in_world_m.knot_spacing_s, 0.033);
    options.knot_spacing_s = 1e-3;
    QVERIFY_THROWS_EXCEPTION(CalibrationError, initialise(input, options, RunContext{}));
  }

  void chosenSpacing_isTold() {
    SimulationOptions simulation;
    simulation.duration_s = 6.0;
    simulation.second_imu = true;
    const Initialisation initial = initialise(simulateInput(simulation).input, {}, RunContext{});
    const auto step =
        std::find_if(initial.steps.begin(), initial.steps.end(),
                     [](const InitialisationStep& each) { return each.name == "knot spacing"; });
    QVERIFY(step != initial.steps.end());
    const double spacing_ms = 1e3 * initial.state.imu_in_world_m.knot_spacing_s;
    QVERIFY2(QString::fromStdString(step->result).startsWith(QString("every %1 ms").arg(spacing_ms)),
             step->result.c_str());
  }
};

EVICAL_TEST(TestKnotSpacing)
#include "tst_knot_spacing.moc"
