#include "core/synthetic/imu_faults.h"

#include "core/base/time.h"
#include "core/synthetic/random.h"

#include <algorithm>
#include <cmath>

namespace evical {
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
