#include "core/synthetic/imu_simulator.h"

#include "core/synthetic/random.h"
#include "core/synthetic/sinusoid_motion.h"

#include "core/base/time.h"

#include <algorithm>
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

namespace {

constexpr std::int64_t kPacket_ns = 50'000'000;

// Gauss-Markov process: a first-order filter of white noise.
void wander(const SimulatedImu& imu, Random random, std::vector<ImuSample>& samples) {
  const ImuFaults& faults = imu.faults;
  if (faults.gyroscope_wander_rad_s <= 0.0 && faults.accelerometer_wander_m_s2 <= 0.0) return;
  const double keeps = std::exp(-1.0 / (faults.wander_time_s * imu.rate_hz));
  const double renews = std::sqrt(1.0 - keeps * keeps);
  Eigen::Vector3d rate = random.normalVector(), force = random.normalVector();
  for (ImuSample& sample : samples) {
    rate = (keeps * rate + renews * random.normalVector()).eval();
    force = (keeps * force + renews * random.normalVector()).eval();
    sample.angular_rate_rad_s += faults.gyroscope_wander_rad_s * rate;
    sample.specific_force_m_s2 += faults.accelerometer_wander_m_s2 * force;
  }
}

void clip(double range, Eigen::Vector3d& value) {
  if (range > 0.0) value = value.cwiseMax(-range).cwiseMin(range).eval();
}
void roundTo(double step, Eigen::Vector3d& value) {
  if (step > 0.0) value = (value.array() / step).round().matrix() * step;
}

std::size_t anyOf(const std::vector<ImuSample>& samples, Random& random) {
  return std::min(static_cast<std::size_t>(random.uniform() * static_cast<double>(samples.size())),
                  samples.size() - 1);
}

void addSpikes(int count, Random random, std::vector<ImuSample>& samples) {
  constexpr double kForce_m_s2 = 150.0, kRate_rad_s = 30.0;
  for (int k = 0; k < count; ++k) {
    ImuSample& sample = samples[anyOf(samples, random)];
    const Eigen::Vector3d direction = random.normalVector().normalized();
    sample.specific_force_m_s2 += kForce_m_s2 * direction;
    sample.angular_rate_rad_s += kRate_rad_s * direction;
  }
}

void spoilStamps(const Scenario& scenario, const ImuFaults& faults, Random random,
                 std::vector<ImuSample>& samples) {
  constexpr double kStepAt = 0.6;
  const std::int64_t first_ns = samples.front().time_ns, length_ns = samples.back().time_ns - first_ns;
  for (ImuSample& sample : samples) {
    const double since_s = secondsSince(first_ns, sample.time_ns);
    const double from_middle_s = since_s - 0.5 * scenario.duration_s;
    double late_s = 1e-6 * faults.clock_drift_ppm * from_middle_s;
    if (since_s > kStepAt * secondsSince(0, length_ns)) late_s += faults.clock_step_s;
    if (faults.stamp_jitter_s > 0.0) late_s += faults.stamp_jitter_s * random.normal();
    sample.time_ns += nanosecondsFrom(late_s);
  }
  // Samples of a batch arrive together, some microseconds apart, after the last one was measured.
  constexpr std::int64_t kApart_ns = 20'000;
  const auto batch = static_cast<std::size_t>(faults.batch);
  for (std::size_t first = 0; batch > 1 && first < samples.size(); first += batch) {
    const std::size_t last = std::min(first + batch, samples.size()) - 1;
    for (std::size_t k = first; k < last; ++k)
      samples[k].time_ns = samples[last].time_ns - static_cast<std::int64_t>(last - k) * kApart_ns;
  }
}

void bringIntoOrder(std::vector<ImuSample>& samples) {
  std::stable_sort(samples.begin(), samples.end(),
                   [](const ImuSample& a, const ImuSample& b) { return a.time_ns < b.time_ns; });
  const auto same = [](const ImuSample& a, const ImuSample& b) { return a.time_ns == b.time_ns; };
  samples.erase(std::unique(samples.begin(), samples.end(), same), samples.end());
}

void lose(const ImuFaults& faults, Random random, std::vector<ImuSample>& samples) {
  if (faults.lost_share > 0.0)
    std::erase_if(samples, [&](const ImuSample&) { return random.uniform() < faults.lost_share; });
  for (int k = 0; k < faults.lost_packets && !samples.empty(); ++k) {
    const std::int64_t from_ns = samples[anyOf(samples, random)].time_ns;
    std::erase_if(samples, [&](const ImuSample& sample) {
      return sample.time_ns > from_ns && sample.time_ns < from_ns + kPacket_ns;
    });
  }
}

}  // namespace

void spoilSamples(const Scenario& scenario, std::size_t index, std::vector<ImuSample>& samples) {
  const SimulatedImu& imu = scenario.imus[index];
  const ImuFaults& faults = imu.faults;
  if (faults == ImuFaults{} || samples.empty()) return;
  // A random stream for each fault, so that one fault does not change another.
  enum Stream : std::uint64_t { Wander = 0x110, Spikes = 0x120, Stamps = 0x130, Losses = 0x140 };
  const auto chance = [&](Stream stream) { return Random(scenario.seed, stream, index); };
  wander(imu, chance(Wander), samples);
  for (ImuSample& sample : samples) {
    clip(faults.gyroscope_range_rad_s, sample.angular_rate_rad_s);
    clip(faults.accelerometer_range_m_s2, sample.specific_force_m_s2);
    roundTo(faults.gyroscope_step_rad_s, sample.angular_rate_rad_s);
    roundTo(faults.accelerometer_step_m_s2, sample.specific_force_m_s2);
  }
  addSpikes(faults.spikes, chance(Spikes), samples);
  spoilStamps(scenario, faults, chance(Stamps), samples);
  bringIntoOrder(samples);
  lose(faults, chance(Losses), samples);
}

}  // namespace evical
