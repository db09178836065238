#include "tests/support/perturbing.h"

#include "core/base/time.h"

#include <cmath>

namespace evical::test {
namespace {

std::int64_t middle_ns(const std::vector<ImuSample>& samples) {
  return samples.front().time_ns + (samples.back().time_ns - samples.front().time_ns) / 2;
}

void sortByTime(std::vector<ImuSample>& samples) {
  std::stable_sort(samples.begin(), samples.end(),
                   [](const ImuSample& a, const ImuSample& b) { return a.time_ns < b.time_ns; });
  const auto same = [](const ImuSample& a, const ImuSample& b) { return a.time_ns == b.time_ns; };
  samples.erase(std::unique(samples.begin(), samples.end(), same), samples.end());
}

// The IMU's stamps run fast by this; truth is the offset in the middle.
void drift(Recorded& recorded, double ppm) {
  std::vector<ImuSample>& samples = samplesOf(recorded);
  const std::int64_t about_ns = middle_ns(samples);
  for (ImuSample& sample : samples)
    sample.time_ns += std::llround(1e-6 * ppm * static_cast<double>(sample.time_ns - about_ns));
}

// Truth is the larger, first part's offset.
void clockStep(Recorded& recorded, double step_ms) {
  constexpr double kFrom = 0.6;
  std::vector<ImuSample>& samples = samplesOf(recorded);
  const auto from = static_cast<std::size_t>(kFrom * static_cast<double>(samples.size()));
  for (std::size_t k = from; k < samples.size(); ++k) samples[k].time_ns += std::llround(1e6 * step_ms);
  sortByTime(samples);
}

void offset(Recorded& recorded, double offset_s) {
  for (SimulatedCamera& camera : recorded.scenario.cameras) camera.time_offset_s += offset_s;
  changeSamples(recorded, [&](ImuSample& sample) { sample.time_ns += std::llround(1e9 * offset_s); });
}

void jitter(Recorded& recorded, double sigma_ms) {
  std::mt19937_64 generator(recorded.scenario.seed);
  std::normal_distribution<double> normal(0.0, sigma_ms);
  changeSamples(recorded,
                [&](ImuSample& sample) { sample.time_ns += std::llround(1e6 * normal(generator)); });
  sortByTime(samplesOf(recorded));
}

void lostSamples(Recorded& recorded, double percent) {
  std::mt19937_64 generator(recorded.scenario.seed);
  std::uniform_real_distribution<double> uniform(0.0, 100.0);
  std::erase_if(samplesOf(recorded), [&](const ImuSample&) { return uniform(generator) < percent; });
}

// Runs of samples like those of a packet: 50 ms each.
void lostPackets(Recorded& recorded, double count) {
  constexpr std::int64_t kLength_ns = 50'000'000;
  std::mt19937_64 generator(recorded.scenario.seed);
  for (int k = 0; k < static_cast<int>(count); ++k) {
    const std::int64_t from_ns = samplesOf(recorded)[anySample(recorded, generator)].time_ns;
    std::erase_if(samplesOf(recorded), [&](const ImuSample& sample) {
      return sample.time_ns > from_ns && sample.time_ns < from_ns + kLength_ns;
    });
  }
}

// Drivers that stamp messages on arrival: this many at a time.
void batches(Recorded& recorded, double samples) {
  simulateFaults(recorded, [&](ImuFaults& faults) { faults.batch = static_cast<int>(samples); });
}

}  // namespace

std::vector<Perturbation> clockPerturbations() {
  return {{"clock drift", "ppm", {50, 200, 1000, 10000}, {"drift", "clock_scale"}, drift},
          {"clock step", "ms", {1, 10, 50, 100}, {"step", "clock"}, clockStep},
          {"time offset", "s", {0.7, 1.5, 5, 30}, {"time offset", "clock"}, offset},
          {"stamp jitter", "ms", {1, 5}, {"stamp", "interval", "jitter"}, jitter},
          {"lost samples", "%", {10, 50, 90}, {"lost", "gap", "no samples", "has a sigma of"}, lostSamples},
          {"lost packets", "", {1, 5, 20}, {"lost", "gap", "no samples"}, lostPackets},
          {"batches", "samples", {5, 20, 50}, {"stamp", "interval", "jitter", "batch"}, batches}};
}

}  // namespace evical::test
