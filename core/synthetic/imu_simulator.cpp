#include "core/synthetic/imu_simulator.h"

#include "core/base/time.h"
#include "core/synthetic/imu_faults.h"
#include "core/synthetic/sinusoid_motion.h"

#include <cmath>
#include <random>

namespace evical {

namespace {

// Calls `use` with every sample and its biases.
template <class Use>
void simulate(const Scenario& scenario, std::size_t index, Use&& use) {
  const SimulatedImu& imu = scenario.imus[index];
  const SinusoidMotion motion(scenario);
  std::mt19937_64 generator(scenario.seed * 104729 + 31 * index + 5);
  std::normal_distribution<double> normal;
  const auto noise = [&] {
    const double x = normal(generator), y = normal(generator), z = normal(generator);
    return Eigen::Vector3d(x, y, z);
  };
  const auto forceAt = [&](double time_s) -> Eigen::Vector3d {
    const MotionState state = motionOfFrame(motion.imuAt(time_s), imu.reference_from_imu);
    return state.world_from_body.rotation.conjugate() *
           (state.acceleration_in_world_m_s2 - scenario.gravity_in_world_m_s2);
  };
  const auto rateAt = [&](double time_s) -> Eigen::Vector3d {
    return motionOfFrame(motion.imuAt(time_s), imu.reference_from_imu).angular_velocity_in_body_rad_s;
  };
  const double cutoff_hz = imu.faults.low_pass_hz;
  const double period_s = 1.0 / imu.rate_hz, root_rate = std::sqrt(imu.rate_hz);
  const Eigen::Matrix3d by_rate = imu.gyroscopeMatrix();
  Eigen::Vector3d gyroscope_bias = imu.gyroscope_bias_rad_s, accelerometer_bias = imu.accelerometer_bias_m_s2;
  const auto count = static_cast<std::size_t>(scenario.duration_s * imu.rate_hz);
  for (std::size_t k = 0; k < count; ++k) {
    const double reference_time_s = static_cast<double>(k) * period_s;
    const Eigen::Vector3d rate = lowPassed(rateAt, reference_time_s, cutoff_hz);
    const Eigen::Vector3d force = lowPassed(forceAt, reference_time_s - imu.accelerometer_delay_s, cutoff_hz);
    ImuSample sample;
    sample.time_ns = scenario.start_ns + nanosecondsFrom(sensorTime_s(imu, reference_time_s));
    const Eigen::Vector3d from_force = imu.faults.g_sensitivity_rad_s_per_m_s2 * force;
    sample.angular_rate_rad_s =
        by_rate * rate + gyroscope_bias + from_force + imu.gyroscope_density * root_rate * noise();
    sample.specific_force_m_s2 = imu.accelerometer_scale_misalignment * force + accelerometer_bias +
                                 imu.accelerometer_density * root_rate * noise();
    use(sample, SimulatedBiases{gyroscope_bias + from_force, accelerometer_bias});
    if (imu.gyroscope_walk > 0.0) gyroscope_bias += imu.gyroscope_walk / root_rate * noise();
    if (imu.accelerometer_walk > 0.0) accelerometer_bias += imu.accelerometer_walk / root_rate * noise();
  }
}

}  // namespace

std::vector<ImuSample> simulateImu(const Scenario& scenario, std::size_t index) {
  std::vector<ImuSample> samples;
  samples.reserve(static_cast<std::size_t>(scenario.duration_s * scenario.imus[index].rate_hz));
  simulate(scenario, index,
           [&](const ImuSample& sample, const SimulatedBiases&) { samples.push_back(sample); });
  spoilSamples(scenario, index, samples);
  return samples;
}

SimulatedBiases meanBiases(const Scenario& scenario, std::size_t index) {
  const SimulatedImu& imu = scenario.imus[index];
  SimulatedBiases sum{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  double count = 0.0;
  if (imu.gyroscope_walk > 0.0 || imu.accelerometer_walk > 0.0 ||
      imu.faults.g_sensitivity_rad_s_per_m_s2 != 0.0)
    simulate(scenario, index, [&](const ImuSample&, const SimulatedBiases& biases) {
      sum.gyroscope_rad_s += biases.gyroscope_rad_s;
      sum.accelerometer_m_s2 += biases.accelerometer_m_s2;
      count += 1.0;
    });
  if (count == 0.0) return {imu.gyroscope_bias_rad_s, imu.accelerometer_bias_m_s2};
  return {sum.gyroscope_rad_s / count, sum.accelerometer_m_s2 / count};
}

}  // namespace evical
