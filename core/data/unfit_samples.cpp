#include "core/data/unfit_samples.h"

#include "core/base/time.h"
#include "core/numerics/robust.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace evical {
namespace {

constexpr int kRunOfLimit_samples = 4;  // consecutive equal samples at an axis's extreme that mean saturation
// Below the smallest full scale of sensors (125 deg/s, 2 g minus a bias), several such runs or a longer one
// are required.
constexpr double kFullScale_rad_s = 2.0, kFullScale_m_s2 = 15.0;
constexpr int kRunsOfLimit = 3, kLongRunOfLimit_samples = 16;
// Largest share of spikes among samples: a larger share is a property of the sensor (repeated values, low
// resolution).
constexpr double kMaxSpikes = 0.02;
// Threshold in medians of the interpolation errors: ten sigmas of a normal distribution.
constexpr double kSpike_medians = 15.0;
constexpr std::ptrdiff_t kNeighbours = 16;  // on either side
constexpr int kMaxRounds = 8;

// The extreme at which the axis stays for several samples, which no motion causes; nullopt if there is none.
std::optional<double> limitAt(std::span<const ImuSample> samples, const ImuAxis& axis, double extreme) {
  const double from = axis.rate ? kFullScale_rad_s : kFullScale_m_s2;
  int run = 0, runs = 0, longest = 0;
  for (const ImuSample& sample : samples) {
    run = axis.of(sample) == extreme ? run + 1 : 0;
    runs += run == kRunOfLimit_samples ? 1 : 0;
    longest = std::max(longest, run);
  }
  const bool seldom = runs < (std::abs(extreme) >= from ? 1 : kRunsOfLimit);
  if (extreme == 0.0 || (seldom && longest < kLongRunOfLimit_samples)) return std::nullopt;
  return extreme;
}

std::vector<std::size_t> saturatedAlong(std::span<const ImuSample> samples, const ImuAxis& axis) {
  const auto less = [&](const ImuSample& a, const ImuSample& b) { return axis.of(a) < axis.of(b); };
  const auto [lowest, highest] = std::minmax_element(samples.begin(), samples.end(), less);
  const std::optional<double> low = limitAt(samples, axis, axis.of(*lowest));
  const std::optional<double> high = limitAt(samples, axis, axis.of(*highest));
  std::vector<std::size_t> saturated;
  for (std::size_t i = 0; i < samples.size() && axis.of(*lowest) < axis.of(*highest); ++i) {
    const double value = axis.of(samples[i]);
    if ((low && value == *low) || (high && value == *high)) saturated.push_back(i);
  }
  return saturated;
}

// Interpolation errors of one axis: distance of each value from the cubic through the two values on either
// side. An isolated error is large compared with its neighbours, even in fast motion.
class SpikeSearch {
 public:
  // `joined`: which values have no gap to their neighbours.
  SpikeSearch(std::vector<double> values, const std::vector<bool>& joined)
      : values_(std::move(values)), joined_(joined) {
    for (std::ptrdiff_t i = 0; i < size(); ++i) errors_.push_back(errorAt(i));
    std::vector<double> steps;  // the smallest step is the resolution
    for (std::size_t i = 1; i < values_.size(); ++i) {
      if (values_[i] != values_[i - 1]) steps.push_back(std::abs(values_[i] - values_[i - 1]));
    }
    const double resolution = steps.empty() ? 0.0 : *std::min_element(steps.begin(), steps.end());
    min_ = kSpike_medians * std::max(medianOf(errors_), resolution);
  }

  std::vector<std::size_t> find() {
    std::vector<std::size_t> found;
    const auto most = static_cast<std::size_t>(kMaxSpikes * static_cast<double>(values_.size()));
    for (int round = 0; round < kMaxRounds; ++round) {
      const std::vector<std::ptrdiff_t> worst = worstOfEachPlace();
      if (worst.empty()) break;
      for (const std::ptrdiff_t i : worst) {
        found.push_back(static_cast<std::size_t>(i));
        at(i) += signedErrorAt(i);  // the cubic's value: reveals errors next to it
        for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(i - 2, 0); k < std::min(i + 3, size()); ++k)
          errors_[static_cast<std::size_t>(k)] = errorAt(k);
      }
      if (found.size() > most) return {};
    }
    return found;
  }

 private:
  std::ptrdiff_t size() const { return static_cast<std::ptrdiff_t>(values_.size()); }
  double& at(std::ptrdiff_t i) { return values_[static_cast<std::size_t>(i)]; }
  double at(std::ptrdiff_t i) const { return values_[static_cast<std::size_t>(i)]; }

  double signedErrorAt(std::ptrdiff_t i) const {
    if (!joined_[static_cast<std::size_t>(i)]) return 0.0;
    return (4.0 * (at(i - 1) + at(i + 1)) - at(i - 2) - at(i + 2)) / 6.0 - at(i);
  }
  double errorAt(std::ptrdiff_t i) const { return std::abs(signedErrorAt(i)); }

  bool standsOut(std::ptrdiff_t i) const {
    const double error = errors_[static_cast<std::size_t>(i)];
    if (!(error > min_)) return false;
    const auto first = errors_.begin() + std::max<std::ptrdiff_t>(i - kNeighbours, 0);
    const auto last = errors_.begin() + std::min(i + kNeighbours + 1, size());
    return error > kSpike_medians * medianOf(std::vector<double>(first, last));
  }

  // Of outliers within two samples of each other the largest, which may have caused the others.
  std::vector<std::ptrdiff_t> worstOfEachPlace() const {
    std::vector<std::ptrdiff_t> worst;
    std::ptrdiff_t last = -kNeighbours;
    for (std::ptrdiff_t i = 0; i < size(); ++i) {
      if (!standsOut(i)) continue;
      if (i - last > 2) {
        worst.push_back(i);
      } else if (errors_[static_cast<std::size_t>(i)] > errors_[static_cast<std::size_t>(worst.back())]) {
        worst.back() = i;
      }
      last = i;
    }
    return worst;
  }

  std::vector<double> values_, errors_;
  const std::vector<bool>& joined_;
  double min_ = 0.0;
};

// True for each sample if the two samples on either side have no gap between them; across gaps, no cubic is
// valid.
std::vector<bool> joinedSamples(std::span<const ImuSample> samples) {
  constexpr double kLongest_periods = 3.0;  // mean of four
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < samples.size(); ++i)
    intervals_s.push_back(secondsSince(samples[i - 1].time_ns, samples[i].time_ns));
  const double longest_s = 4.0 * kLongest_periods * medianOf(std::move(intervals_s));
  std::vector<bool> joined(samples.size(), false);
  for (std::size_t i = 2; i + 2 < samples.size(); ++i)
    joined[i] = secondsSince(samples[i - 2].time_ns, samples[i + 2].time_ns) <= longest_s;
  return joined;
}

// If a driver repeats each sample of a slow sensor until the next, all three axes repeat for about the same
// number of samples. A sensor at rest and a coarse sensor repeat too, but less regularly.
std::vector<std::size_t> repeatsOf(std::span<const ImuSample> samples, bool rate) {
  constexpr std::size_t kFewestRuns = 20;
  constexpr double kRegular = 0.95;  // share of runs whose length is the median's within one sample
  const auto values = [rate](const ImuSample& sample) -> const Eigen::Vector3d& {
    return rate ? sample.angular_rate_rad_s : sample.specific_force_m_s2;
  };
  std::vector<std::size_t> repeats;
  std::vector<double> runs;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i > 0 && values(samples[i]) == values(samples[i - 1])) {
      repeats.push_back(i);
      runs.back() += 1.0;
    } else {
      runs.push_back(1.0);
    }
  }
  if (runs.size() < kFewestRuns) return {};
  const double usual = medianOf(runs);
  const auto regular = std::count_if(runs.begin() + 1, runs.end() - 1,
                                     [usual](double run) { return std::abs(run - usual) <= 1.0; });
  const bool held =
      usual >= 2.0 && static_cast<double>(regular) >= kRegular * static_cast<double>(runs.size() - 2);
  return held ? repeats : std::vector<std::size_t>{};
}

std::vector<std::size_t> spikes(std::span<const ImuSample> samples, bool rate) {
  std::vector<std::size_t> found;
  const std::vector<bool> joined = joinedSamples(samples);
  for (const ImuAxis& axis : kImuAxes) {
    if (axis.rate != rate) continue;
    std::vector<double> values;
    for (const ImuSample& sample : samples) values.push_back(axis.of(sample));
    const std::vector<std::size_t> along = SpikeSearch(std::move(values), joined).find();
    found.insert(found.end(), along.begin(), along.end());
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

void findUnfitOf(std::span<const ImuSample> samples, bool rate, UnfitSamples& unfit) {
  std::vector<std::size_t> clipped;
  for (std::size_t axis = 0; axis < kImuAxes.size(); ++axis) {
    if (kImuAxes[axis].rate != rate) continue;
    unfit.saturated[axis] = saturatedAlong(samples, kImuAxes[axis]);
    clipped.insert(clipped.end(), unfit.saturated[axis].begin(), unfit.saturated[axis].end());
  }
  std::vector<std::size_t>& found = rate ? unfit.gyroscope_spikes : unfit.accelerometer_spikes;
  found = spikes(samples, rate);
  // The kink at the beginning of a saturation is not a spike.
  std::erase_if(found, [&](std::size_t i) {
    return std::any_of(clipped.begin(), clipped.end(),
                       [i](std::size_t k) { return k <= i + 1 && i <= k + 1; });
  });
}

bool isMeasured(const ImuSample& sample, bool rate) {
  return rate ? measuresRate(sample) : measuresForce(sample);
}

// A subset of the samples and their indices in the list. Without a copy if all are selected.
struct OwnSamples {
  std::span<const ImuSample> samples;
  std::vector<std::size_t> places, others;  // places: empty if all are selected

  template <class IsOwn>
  OwnSamples(std::span<const ImuSample> all, IsOwn&& isOwn) : samples(all) {
    for (std::size_t i = 0; i < all.size(); ++i)
      if (!isOwn(i)) others.push_back(i);
    if (others.empty()) return;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!isOwn(i)) continue;
      places.push_back(i);
      copies_.push_back(all[i]);
    }
    samples = copies_;
  }
  OwnSamples(const OwnSamples&) = delete;
  OwnSamples& operator=(const OwnSamples&) = delete;

  void bringBack(std::vector<std::size_t>& found) const {
    if (others.empty()) return;
    for (std::size_t& i : found) i = places[i];
  }

 private:
  std::vector<ImuSample> copies_;
};

std::vector<ImuSample> those(std::span<const ImuSample> samples, const std::vector<std::uint8_t>& fit) {
  std::vector<ImuSample> kept;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (fit[i]) kept.push_back(samples[i]);
  }
  return kept;
}

}  // namespace

bool isMeasurable(const ImuSample& sample) {
  constexpr double kLargest_rad_s = 1e4, kLargest_m_s2 = 1e5;
  // False for NaN.
  return sample.angular_rate_rad_s.cwiseAbs().sum() <= kLargest_rad_s &&
         sample.specific_force_m_s2.cwiseAbs().sum() <= kLargest_m_s2;
}

UnfitSamples findUnfitSamples(std::span<const ImuSample> samples) {
  UnfitSamples unfit;
  if (samples.empty()) return unfit;
  for (const bool rate : {true, false}) {
    const OwnSamples own(samples, [&](std::size_t i) { return isMeasured(samples[i], rate); });
    (rate ? unfit.without_rate : unfit.without_force) = own.others;
    if (own.samples.empty()) continue;
    std::vector<std::size_t>& repeats = rate ? unfit.gyroscope_repeats : unfit.accelerometer_repeats;
    repeats = repeatsOf(own.samples, rate);
    // A repeated sample looks like saturation: only the first of each counts.
    const OwnSamples firsts(
        own.samples, [&](std::size_t i) { return !std::binary_search(repeats.begin(), repeats.end(), i); });
    findUnfitOf(firsts.samples, rate, unfit);
    own.bringBack(repeats);
    const auto bringBack = [&](std::vector<std::size_t>& found) {
      firsts.bringBack(found);
      own.bringBack(found);
    };
    for (std::size_t axis = 0; axis < kImuAxes.size(); ++axis)
      if (kImuAxes[axis].rate == rate) bringBack(unfit.saturated[axis]);
    bringBack(rate ? unfit.gyroscope_spikes : unfit.accelerometer_spikes);
  }
  return unfit;
}

std::array<double, kImuAxes.size()> saturatedShares(std::span<const ImuSample> samples) {
  const UnfitSamples unfit = findUnfitSamples(samples);
  std::array<double, kImuAxes.size()> shares{};
  for (std::size_t axis = 0; axis < kImuAxes.size(); ++axis) {
    const std::size_t others = (kImuAxes[axis].rate ? unfit.without_rate : unfit.without_force).size();
    shares[axis] = static_cast<double>(unfit.saturated[axis].size()) /
                   std::max(1.0, static_cast<double>(samples.size() - others));
  }
  return shares;
}

std::vector<RecordingFault> heldFaults(const std::string& stream, std::span<const ImuSample> samples,
                                       const UnfitSamples& unfit) {
  std::vector<RecordingFault> faults;
  if (samples.size() < 2) return faults;
  const double whole_s = secondsSince(samples.front().time_ns, samples.back().time_ns);
  const auto tell = [&](const char* sensor, const std::vector<std::size_t>& repeats, std::size_t others) {
    if (repeats.empty()) return;
    const double rate_hz = static_cast<double>(samples.size() - others - 1) / whole_s;
    const double own_hz = rate_hz - static_cast<double>(repeats.size()) / whole_s;
    faults.push_back(
        {stream, FaultKind::Held, 0.0,
         fmt::format("The {} measures at {:.1f} Hz, but its samples are repeated at {:.1f} Hz: calibrations "
                     "use each of them once.",
                     sensor, own_hz, rate_hz)});
  };
  tell("gyroscope", unfit.gyroscope_repeats, unfit.without_rate.size());
  tell("accelerometer", unfit.accelerometer_repeats, unfit.without_force.size());
  return faults;
}

SampleSelection fitSamples(std::span<const ImuSample> samples) {
  const UnfitSamples unfit = findUnfitSamples(samples);
  SampleSelection fit{std::vector<std::uint8_t>(samples.size(), 1),
                      std::vector<std::uint8_t>(samples.size(), 1)};
  for (std::size_t axis = 0; axis < kImuAxes.size(); ++axis) {
    const bool rate = kImuAxes[axis].rate;
    std::vector<std::uint8_t>& sensor = rate ? fit.gyroscope : fit.accelerometer;
    // Also the sensor's own samples before and after.
    for (const std::size_t i : unfit.saturated[axis]) {
      sensor[i] = 0;
      for (std::size_t k = i; k-- > 0;) {
        sensor[k] = 0;
        if (isMeasured(samples[k], rate)) break;
      }
      for (std::size_t k = i + 1; k < samples.size(); ++k) {
        sensor[k] = 0;
        if (isMeasured(samples[k], rate)) break;
      }
    }
  }
  for (const std::size_t i : unfit.gyroscope_spikes) fit.gyroscope[i] = 0;
  for (const std::size_t i : unfit.accelerometer_spikes) fit.accelerometer[i] = 0;
  for (const auto* const left_out : {&unfit.gyroscope_repeats, &unfit.without_rate})
    for (const std::size_t i : *left_out) fit.gyroscope[i] = 0;
  for (const auto* const left_out : {&unfit.accelerometer_repeats, &unfit.without_force})
    for (const std::size_t i : *left_out) fit.accelerometer[i] = 0;
  return fit;
}

std::vector<ImuSample> withoutRateSpikes(std::span<const ImuSample> samples) {
  std::vector<std::uint8_t> kept(samples.size(), 1);
  const UnfitSamples unfit = findUnfitSamples(samples);
  for (const auto* const left_out : {&unfit.gyroscope_spikes, &unfit.without_rate})
    for (const std::size_t i : *left_out) kept[i] = 0;
  return those(samples, kept);
}

std::vector<ImuSample> withFitForces(std::span<const ImuSample> samples) {
  return those(samples, fitSamples(samples).accelerometer);
}

}  // namespace evical
