#include "core/base/time.h"
#include "core/geometry/so3.h"
#include "core/synthetic/imu_simulator.h"
#include "core/synthetic/sinusoid_motion.h"
#include "tests/core/synthetic/scenarios.h"
#include "tests/support/test_program.h"

#include <functional>

using namespace evical;

Q_DECLARE_METATYPE(evical::ImuFaults)
Q_DECLARE_METATYPE(
    std::function<bool(const std::vector<evical::ImuSample>&, const std::vector<evical::ImuSample>&)>)

class TestImuSimulator : public QObject {
  Q_OBJECT
 private slots:
  void atRest_measuresGravityUpwards() {
    Scenario scenario = test::stillScenario();
    const std::vector<ImuSample> samples = simulateImu(scenario, 0);
    QCOMPARE(samples.size(), std::size_t{1000});
    const Eigen::Quaterniond world_from_imu = SinusoidMotion(scenario).imuAt(0.3).world_from_body.rotation;
    for (const ImuSample& sample : samples) {
      QVERIFY(sample.angular_rate_rad_s.norm() < 1e-12);
      QVERIFY((world_from_imu * sample.specific_force_m_s2 + scenario.gravity_in_world_m_s2).norm() < 1e-9);
    }
  }
  void biasAndMapping_comeAfterTheMotion() {
    Scenario scenario = test::wavedScenario();
    const std::vector<ImuSample> ideal = simulateImu(scenario, 0);
    SimulatedImu& imu = scenario.imus.front();
    imu.gyroscope_bias_rad_s = {0.1, -0.2, 0.3};
    imu.accelerometer_bias_m_s2 = {-0.4, 0.5, 0.6};
    imu.gyroscope_scale_misalignment << 1.02, 0.01, -0.02, 0.0, 0.97, 0.03, 0.0, 0.0, 1.01;
    imu.accelerometer_scale_misalignment << 0.99, -0.01, 0.02, 0.0, 1.03, -0.03, 0.0, 0.0, 0.98;
    imu.gyroscope_from_accelerometer = quaternionExp({0.0, 0.0, 0.02});
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitZ()).toRotationMatrix();  // gyroscope from IMU
    const std::vector<ImuSample> real = simulateImu(scenario, 0);
    for (std::size_t k = 0; k < real.size(); k += 50) {
      QVERIFY(
          (real[k].angular_rate_rad_s -
           (imu.gyroscope_scale_misalignment * turn * ideal[k].angular_rate_rad_s + imu.gyroscope_bias_rad_s))
              .norm() < 1e-12);
      QVERIFY((real[k].specific_force_m_s2 -
               (imu.accelerometer_scale_misalignment * ideal[k].specific_force_m_s2 +
                imu.accelerometer_bias_m_s2))
                  .norm() < 1e-12);
    }
  }
  // Delayed by three samples: specific forces are those of three samples before, rates are not.
  void lateAccelerometer_measuresWhatWas() {
    Scenario scenario = test::wavedScenario();
    const std::vector<ImuSample> prompt = simulateImu(scenario, 0);
    scenario.imus.front().accelerometer_delay_s = 3.0 / scenario.imus.front().rate_hz;
    const std::vector<ImuSample> late = simulateImu(scenario, 0);
    for (std::size_t k = 3; k < late.size(); k += 50) {
      QVERIFY((late[k].specific_force_m_s2 - prompt[k - 3].specific_force_m_s2).norm() < 1e-9);
      QVERIFY(late[k].angular_rate_rad_s == prompt[k].angular_rate_rad_s);
    }
  }
  // Amplitude of 5 Hz after a filter of 20 Hz: 1 / sqrt(1 + (5/20)^2); without delay.
  void lowPass_flattensWithoutDelay() {
    Scenario scenario = test::stillScenario();
    scenario.motion.angle_amplitude_rad = {0.0, 0.1, 0.0};
    scenario.motion.sinusoids = 1;
    scenario.motion.lowest_frequency_hz = scenario.motion.highest_frequency_hz = 5.0;
    const std::vector<ImuSample> prompt = simulateImu(scenario, 0);
    scenario.imus.front().faults.low_pass_hz = 20.0;
    const std::vector<ImuSample> flat = simulateImu(scenario, 0);
    double products = 0.0, squares = 0.0, flat_squares = 0.0;
    for (std::size_t k = 0; k < prompt.size(); ++k) {
      products += prompt[k].angular_rate_rad_s.dot(flat[k].angular_rate_rad_s);
      squares += prompt[k].angular_rate_rad_s.squaredNorm();
      flat_squares += flat[k].angular_rate_rad_s.squaredNorm();
    }
    QVERIFY(std::abs(std::sqrt(flat_squares / squares) - 1.0 / std::sqrt(1.0 + 1.0 / 16.0)) < 2e-3);
    QVERIFY(products / std::sqrt(squares * flat_squares) > 0.9999);
  }
  void faults_areThoseAskedFor_data() {
    QTest::addColumn<ImuFaults>("faults");
    QTest::addColumn<std::function<bool(const std::vector<ImuSample>&, const std::vector<ImuSample>&)>>(
        "shows");
    using Samples = std::vector<ImuSample>;
    using Shows = std::function<bool(const Samples&, const Samples&)>;
    const auto row = [](const char* name, const ImuFaults& faults, Shows shows) {
      QTest::newRow(name) << faults << std::move(shows);
    };
    row("range", {.accelerometer_range_m_s2 = 8.0}, [](const Samples&, const Samples& spoilt) {
      return std::all_of(spoilt.begin(), spoilt.end(), [](const ImuSample& s) {
        return s.specific_force_m_s2.cwiseAbs().maxCoeff() <= 8.0;
      });
    });
    row("steps", {.gyroscope_step_rad_s = 0.01}, [](const Samples& ideal, const Samples& spoilt) {
      const double x = spoilt[77].angular_rate_rad_s.x() / 0.01;
      return std::abs(x - std::round(x)) < 1e-9 &&
             (ideal[77].angular_rate_rad_s - spoilt[77].angular_rate_rad_s).cwiseAbs().maxCoeff() <= 0.005001;
    });
    row("g-sensitivity", {.g_sensitivity_rad_s_per_m_s2 = 1e-3},
        [](const Samples& ideal, const Samples& spoilt) {
          return (spoilt[9].angular_rate_rad_s - ideal[9].angular_rate_rad_s -
                  1e-3 * ideal[9].specific_force_m_s2)
                     .norm() < 1e-12;
        });
    row("spikes", {.spikes = 3}, [](const Samples& ideal, const Samples& spoilt) {
      int count = 0;
      for (std::size_t k = 0; k < ideal.size(); ++k)
        count += (ideal[k].specific_force_m_s2 - spoilt[k].specific_force_m_s2).norm() > 100.0;
      return count == 3;
    });
    row("drift", {.clock_drift_ppm = 1000.0}, [](const Samples& ideal, const Samples& spoilt) {
      return ideal[0].time_ns - spoilt[0].time_ns == 500'000 && ideal[500].time_ns == spoilt[500].time_ns;
    });
    row("step", {.clock_step_s = 0.02}, [](const Samples& ideal, const Samples& spoilt) {
      return ideal[590].time_ns == spoilt[590].time_ns &&
             spoilt[610].time_ns - ideal[610].time_ns == 20'000'000;
    });
    row("batches", {.batch = 5}, [](const Samples& ideal, const Samples& spoilt) {
      return spoilt[4].time_ns == ideal[4].time_ns && spoilt[4].time_ns - spoilt[0].time_ns == 80'000;
    });
    row("lost", {.lost_share = 0.5},
        [](const Samples&, const Samples& spoilt) { return spoilt.size() > 430 && spoilt.size() < 570; });
    row("packet", {.lost_packets = 1}, [](const Samples& ideal, const Samples& spoilt) {
      return ideal.size() - spoilt.size() > 0 && ideal.size() - spoilt.size() < 50;
    });
  }
  void faults_areThoseAskedFor() {
    using Samples = std::vector<ImuSample>;
    QFETCH(ImuFaults, faults);
    using Shows = std::function<bool(const Samples&, const Samples&)>;
    QFETCH(Shows, shows);
    Scenario scenario = test::wavedScenario();
    const Samples ideal = simulateImu(scenario, 0);
    scenario.imus.front().faults = faults;
    const Samples spoilt = simulateImu(scenario, 0);
    QVERIFY(shows(ideal, spoilt));
    QVERIFY(!shows(ideal, ideal));
    const auto before = [](const ImuSample& a, const ImuSample& b) { return a.time_ns < b.time_ns; };
    QVERIFY(std::is_sorted(spoilt.begin(), spoilt.end(), before));
  }
  void wander_lastsAsLongAsSaid() {
    Scenario scenario = test::stillScenario();
    scenario.duration_s = 20.0;
    scenario.imus.front().faults = {.gyroscope_wander_rad_s = 0.1, .wander_time_s = 0.02};
    const std::vector<ImuSample> samples = simulateImu(scenario, 0);
    double squares = 0.0, products = 0.0;  // with samples 20 periods, one such time, later
    for (std::size_t k = 0; k + 20 < samples.size(); ++k) {
      squares += samples[k].angular_rate_rad_s.squaredNorm();
      products += samples[k].angular_rate_rad_s.dot(samples[k + 20].angular_rate_rad_s);
    }
    const double sigma = std::sqrt(squares / (3.0 * static_cast<double>(samples.size())));
    QVERIFY(std::abs(sigma / 0.1 - 1.0) < 0.1);
    QVERIFY(std::abs(products / squares - std::exp(-1.0)) < 0.1);
  }
  void noise_hasTheStatedDensity() {
    Scenario scenario = test::stillScenario();
    scenario.duration_s = 10.0;
    SimulatedImu& imu = scenario.imus.front();
    imu.rate_hz = 400.0;
    imu.gyroscope_density = 2e-3;
    double squares = 0.0;
    const std::vector<ImuSample> samples = simulateImu(scenario, 0);
    for (const ImuSample& sample : samples) squares += sample.angular_rate_rad_s.squaredNorm();
    const double sigma = std::sqrt(squares / (3.0 * static_cast<double>(samples.size())));
    QVERIFY(std::abs(sigma / (2e-3 * 20.0) - 1.0) < 0.03);  // 12000 numbers: 0.65 % is one sigma
  }
  void randomWalk_growsWithTheRootOfTime() {
    Scenario scenario = test::stillScenario();
    scenario.duration_s = 4.0;
    scenario.imus.front().gyroscope_walk = 1e-2;
    double squares = 0.0;
    constexpr int kSeeds = 100;
    for (int seed = 0; seed < kSeeds; ++seed) {
      scenario.seed = static_cast<std::uint64_t>(seed);
      squares += simulateImu(scenario, 0).back().angular_rate_rad_s.squaredNorm();
    }
    const double sigma = std::sqrt(squares / (3.0 * kSeeds));
    QVERIFY(std::abs(sigma / (1e-2 * 2.0) - 1.0) < 0.2);
  }
  // At rest and without noise, a gyroscope measures its bias.
  void meanBiases_areThoseInTheSamples() {
    Scenario scenario = test::stillScenario();
    SimulatedImu& imu = scenario.imus.front();
    imu.gyroscope_bias_rad_s = {0.1, 0.2, 0.3};
    QVERIFY(meanBiases(scenario, 0).gyroscope_rad_s == imu.gyroscope_bias_rad_s);
    imu.gyroscope_walk = 1e-2;
    imu.gyroscope_density = imu.accelerometer_density = 0.0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const std::vector<ImuSample> samples = simulateImu(scenario, 0);
    for (const ImuSample& sample : samples) sum += sample.angular_rate_rad_s;
    const SimulatedBiases mean = meanBiases(scenario, 0);
    QVERIFY((mean.gyroscope_rad_s - sum / static_cast<double>(samples.size())).norm() < 1e-12);
    QVERIFY((mean.gyroscope_rad_s - imu.gyroscope_bias_rad_s).norm() > 1e-4);
    QVERIFY((mean.accelerometer_m_s2 - imu.accelerometer_bias_m_s2).norm() < 1e-12);
  }
  void clock_isTheImusOwn() {
    Scenario scenario = test::wavedScenario();
    scenario.imus.resize(2);
    scenario.imus[1].gyroscope_density = scenario.imus[1].accelerometer_density = 0.0;
    scenario.imus[1].time_offset_s = 0.25;
    const ImuSample sample = simulateImu(scenario, 1)[100];
    QCOMPARE(sample.time_ns, scenario.start_ns + 100'000'000 - 250'000'000);
    QCOMPARE(sample.angular_rate_rad_s, simulateImu(scenario, 0)[100].angular_rate_rad_s);
  }
  void leverArm_addsTheRotationsAcceleration() {
    Scenario scenario = test::wavedScenario();
    scenario.imus.resize(2);
    scenario.imus[1].gyroscope_density = scenario.imus[1].accelerometer_density = 0.0;
    scenario.imus[1].reference_from_imu.rotation = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5);
    scenario.imus[1].reference_from_imu.translation_m = {0.1, -0.2, 0.3};
    const RigidTransform& mount = scenario.imus[1].reference_from_imu;
    const SinusoidMotion motion(scenario);
    const auto place = [&](double t) { return motion.imuAt(t).world_from_body * mount.translation_m; };
    const double t = 0.4, h = 1e-4;
    const Eigen::Vector3d acceleration = (place(t + h) - 2.0 * place(t) + place(t - h)) / (h * h);
    const Eigen::Quaterniond world_from_imu = motion.imuAt(t).world_from_body.rotation * mount.rotation;
    const Eigen::Vector3d expected =
        world_from_imu.conjugate() * (acceleration - scenario.gravity_in_world_m_s2);
    QVERIFY((simulateImu(scenario, 1)[400].specific_force_m_s2 - expected).norm() < 1e-5);
  }
};

EVICAL_TEST(TestImuSimulator)
#include "tst_imu_simulator.moc"
