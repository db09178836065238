#include "core/data/imu_stamps.h"

#include "core/base/number.h"
#include "core/base/option_table.h"
#include "core/base/time.h"
#include "core/data/second_clock.h"
#include "core/numerics/robust.h"
#include "core/numerics/taut_string.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

namespace evical {
namespace {

using Times = std::vector<std::int64_t>;

constexpr std::tuple kStampFields{
    Field{"finest_step_ms", &StampOptions::finest_step_ms, 0.1, within(0.01, 10.0), "ms",
          "Steps of stamps up to this size are not coarse: a tenth of a good recording's sigma of time "
          "offsets."},
    Field{"share_on_grid", &StampOptions::share_on_grid, 0.98, within(0.5, 1.0), "",
          "Smallest share of the intervals that are multiples of a step; others are strays."},
    Field{"share_of_equal", &StampOptions::share_of_equal, 0.1, within(0.0, 1.0), "",
          "Smallest share of stamps that equal the one before; fewer are a driver's mistake."},
    Field{"share_of_bends", &StampOptions::share_of_bends, 0.1, within(0.0, 1.0), "",
          "Largest share of samples at which a steady rate bends; more if the samples' own times scatter."},
    Field{"share_of_copies", &StampOptions::share_of_copies, 0.99, within(0.0, 1.0), "",
          "Smallest share of equal stamps with equal values if a log was written twice."},
    Field{"beat_scatter", &StampOptions::beat_scatter, 0.35, within(0.0, 1.0), "",
          "Largest relative scatter of the distances between unusual intervals of a beat; 1 for losses."},
    Field{"beat_share", &StampOptions::beat_share, 0.5, within(0.0, 1.0), "",
          "Smallest share of the recording with a beat; a stretch of it may have another rate or clock."},
    Field{"max_beat", &StampOptions::max_beat, 10.0, within(1.0, 1000.0), "samples",
          "Longest constant distance between unusual intervals of a beat; a driver may drop each fiftieth "
          "sample."},
    Field{"gap_periods", &StampOptions::gap_periods, 2.5, within(1.0, 100.0), "periods",
          "Smallest interval in which samples are missing, in addition to 1.5 steps."},
    Field{"lost_periods", &StampOptions::lost_periods, 0.7, within(0.1, 1.0), "periods",
          "Smallest delay of all later stamps that shows a lost sample without a gap."}};
constexpr auto kStampDefaults = defaultsOf<StampOptions, kStampFields>();

constexpr std::int64_t kStampError_ns =
    2'000;                                 // of a multiple of a step: times since 1970 in double precision
constexpr std::size_t kFewestStamps = 50;  // that show a step
constexpr std::size_t kFewestBetween = 3;  // intervals that no number of lost samples explains
// Longer and shorter intervals at nearly equal distances are a beat between two rates; losses come at any
// distance.
constexpr std::size_t kFewestRegular = 8;

bool isMultiple(std::int64_t interval_ns, std::int64_t step_ns) {
  const std::int64_t rest_ns = interval_ns % step_ns;
  return std::min(rest_ns, step_ns - rest_ns) <= kStampError_ns;
}

struct Intervals {
  Times all, positive,
      recurring;  // the last two ascending; recurring: lengths that occur at least twice, at most 16 medians
  std::int64_t median_ns = 0;  // of the positive ones

  explicit Intervals(std::span<const std::int64_t> times_ns) {
    constexpr std::int64_t kLongest_medians = 16;
    for (std::size_t i = 1; i < times_ns.size(); ++i) all.push_back(times_ns[i] - times_ns[i - 1]);
    std::ranges::copy_if(all, std::back_inserter(positive), [](std::int64_t each) { return each > 0; });
    if (positive.empty()) return;
    std::ranges::sort(positive);
    median_ns = positive[positive.size() / 2];
    for (std::size_t i = 1; i < positive.size() && positive[i] <= kLongest_medians * median_ns; ++i)
      if (positive[i] - positive[i - 1] <= kStampError_ns / 2 &&
          (recurring.empty() || positive[i] - recurring.back() > kStampError_ns))
        recurring.push_back(positive[i]);
  }
};

// The largest step of which recurring intervals are multiples: Euclid's algorithm with a tolerance. 0 if it
// is fine.
std::int64_t gridOf(const Intervals& intervals, const StampOptions& options) {
  if (intervals.recurring.empty()) return 0;
  const double finest_ns = 1e6 * options.finest_step_ms;
  double step_ns = static_cast<double>(intervals.recurring.front());
  for (const std::int64_t interval_ns : intervals.recurring) {
    double longer_ns = static_cast<double>(interval_ns);
    while (step_ns > finest_ns) {
      const double count = std::round(longer_ns / step_ns);
      const double rest_ns = std::abs(longer_ns - count * step_ns);
      if (rest_ns <= static_cast<double>(kStampError_ns)) {
        if (longer_ns == static_cast<double>(interval_ns)) step_ns = longer_ns / count;  // more exact
        break;
      }
      longer_ns = std::exchange(step_ns, rest_ns);
    }
  }
  const std::int64_t grid_ns = std::llround(step_ns);
  if (grid_ns <= std::llround(finest_ns) + kStampError_ns) return 0;
  const auto on_grid =
      std::ranges::count_if(intervals.positive, [&](std::int64_t each) { return isMultiple(each, grid_ns); });
  return static_cast<double>(on_grid) >=
                 options.share_on_grid * static_cast<double>(intervals.positive.size())
             ? grid_ns
             : 0;
}

// True if intervals that differ from the median come at nearly equal distances.
bool haveBeat(const Intervals& intervals, const StampOptions& options) {
  constexpr double kConstant = 1e-3;  // variance
  std::vector<double> distances;
  std::size_t last = 0;
  for (std::size_t i = 0; i < intervals.all.size(); ++i) {
    if (std::abs(intervals.all[i] - intervals.median_ns) <= kStampError_ns) continue;
    if (last > 0) distances.push_back(static_cast<double>(i + 1 - last));
    last = i + 1;
  }
  double sum = 0.0, squares = 0.0;
  for (const double each : distances) {
    sum += each;
    squares += each * each;
  }
  // A stretch of a recording may have another rate or clock.
  if (distances.size() < kFewestRegular ||
      sum < options.beat_share * static_cast<double>(intervals.all.size()))
    return false;
  const double count = static_cast<double>(distances.size()), mean = sum / count;
  const double variance = squares / count - mean * mean;
  // A driver that drops every fiftieth sample has constant distances, a beat of two clocks hardly ever.
  if (variance < kConstant && mean > options.max_beat) return false;
  return variance < options.beat_scatter * options.beat_scatter * mean * mean;
}

// Equal stamps in a row that no longer interval next to them makes up for: more samples than a steady rate
// has.
std::size_t samplesTooMany(const Intervals& intervals) {
  const Times& all = intervals.all;
  const auto isLonger = [&](std::size_t i) {
    return i < all.size() && all[i] > intervals.median_ns + kStampError_ns;
  };
  std::size_t count = 0;
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end + 1) {
    for (end = begin; end < all.size() && all[end] == 0;) ++end;
    if (!isLonger(end) && !(begin > 0 && isLonger(begin - 1))) count += end - begin;
  }
  return count;
}

// 0 for stamps that are not coarse. `repeats`: samples that are sent twice, with the same values.
std::int64_t stepOf(std::span<const std::int64_t> times_ns, std::size_t repeats,
                    const StampOptions& options) {
  if (times_ns.size() < kFewestStamps) return 0;
  const Intervals intervals(times_ns);
  if (intervals.positive.size() < 2) return 0;
  const std::size_t zeros = intervals.all.size() - intervals.positive.size();
  const bool equal = static_cast<double>(zeros - std::min(zeros, repeats)) >=
                     options.share_of_equal * static_cast<double>(intervals.all.size());
  const std::int64_t grid_ns = gridOf(intervals, options);
  if (equal) return std::max(grid_ns, intervals.median_ns);
  if (grid_ns == 0) return 0;
  const auto between = static_cast<std::size_t>(std::ranges::count_if(
      intervals.positive, [&](std::int64_t each) { return !isMultiple(each, intervals.median_ns); }));
  const bool coarse = between >= kFewestBetween || samplesTooMany(intervals) >= repeats + kFewestBetween ||
                      haveBeat(intervals, options);
  return coarse ? grid_ns : 0;
}

// Steps of parts of a recording: times with five digits become coarser as time goes on.
class StampSteps {
 public:
  StampSteps(const Times& times_ns, const std::vector<bool>& is_repeat, const StampOptions& options)
      : size_(times_ns.size()) {
    const auto repeatsIn = [&](std::size_t from, std::size_t to) {
      return static_cast<std::size_t>(std::count(is_repeat.begin() + static_cast<std::ptrdiff_t>(from),
                                                 is_repeat.begin() + static_cast<std::ptrdiff_t>(to), true));
    };
    const std::int64_t whole_ns = stepOf(times_ns, repeatsIn(0, size_), options);
    for (std::size_t k = 0; k < kParts; ++k) {
      const std::size_t from = k * size_ / kParts, to = (k + 1) * size_ / kParts;
      steps_ns_[k] = std::max(
          whole_ns, stepOf(std::span(times_ns).subspan(from, to - from), repeatsIn(from, to), options));
    }
    // A change within a part.
    const std::array<std::int64_t, kParts> found_ns = steps_ns_;
    for (std::size_t k = 0; k < kParts; ++k)
      if (found_ns[k] == 0)
        steps_ns_[k] = std::max(found_ns[k > 0 ? k - 1 : k], found_ns[std::min(k + 1, kParts - 1)]);
  }
  std::int64_t largest_ns() const { return *std::ranges::max_element(steps_ns_); }
  std::int64_t at_ns(std::size_t sample) const { return steps_ns_[sample * kParts / size_]; }

 private:
  static constexpr std::size_t kParts = 8;
  std::size_t size_;
  std::array<std::int64_t, kParts> steps_ns_{};
};

// Number of each sample, with those missing in gaps.
std::vector<double> sampleNumbers(const Times& times_ns, const StampSteps& steps,
                                  const StampOptions& options) {
  constexpr double kGap_steps = 1.5;
  const double period_ns =
      static_cast<double>(times_ns.back() - times_ns.front()) / static_cast<double>(times_ns.size() - 1);
  const auto isGap = [&](std::size_t i, double usual_ns) {
    return static_cast<double>(times_ns[i] - times_ns[i - 1]) >
           options.gap_periods * usual_ns + kGap_steps * static_cast<double>(steps.at_ns(i));
  };
  double sum_ns = 0.0, count = 0.0;
  for (std::size_t i = 1; i < times_ns.size(); ++i) {
    if (isGap(i, period_ns)) continue;
    sum_ns += static_cast<double>(times_ns[i] - times_ns[i - 1]);
    count += 1.0;
  }
  const double usual_ns = count > 0.0 ? sum_ns / count : period_ns;
  std::vector<double> numbers{0.0};
  for (std::size_t i = 1; i < times_ns.size(); ++i) {
    const double periods = static_cast<double>(times_ns[i] - times_ns[i - 1]) / usual_ns;
    numbers.push_back(numbers.back() + (isGap(i, usual_ns) ? std::max(1.0, std::round(periods)) : 1.0));
  }
  return numbers;
}

// Adds samples that are lost without a gap in the stamps: from there on, all are later by a period. Means of
// some steps before and after average the rounding.
void addLost(const Times& times_ns, std::int64_t step_ns, double min_loss, std::vector<double>& numbers) {
  constexpr double kFewest = 16.0, kMin = 1.5, kNoise_medians = 6.0;
  const std::size_t size = times_ns.size();
  const double mean_ns = static_cast<double>(times_ns.back() - times_ns.front()) / numbers.back();
  const double per_step = static_cast<double>(step_ns) / mean_ns;
  if (per_step < kMin) return;  // a loss is a gap, or looks like a beat
  const auto width = static_cast<std::size_t>(std::llround(std::ceil(kFewest / per_step) * per_step));
  if (width < 2 || size < 4 * width) return;
  std::vector<double> stamp_sums{0.0}, number_sums{0.0};
  for (std::size_t i = 0; i < size; ++i) {
    stamp_sums.push_back(stamp_sums.back() + static_cast<double>(times_ns[i] - times_ns.front()));
    number_sums.push_back(number_sums.back() + numbers[i]);
  }
  const auto rise = [&](const std::vector<double>& sums, std::size_t i) {
    return (sums[i + width] - 2.0 * sums[i] + sums[i - width]) / static_cast<double>(width);
  };
  std::vector<double> periods_ns;
  for (std::size_t i = width; i + width <= size; ++i)
    periods_ns.push_back(rise(stamp_sums, i) / rise(number_sums, i));
  const double period_ns = medianOf(periods_ns);
  std::vector<double> late(size, 0.0), errors;  // in periods
  for (std::size_t i = width; i + width <= size; ++i) {
    late[i] = rise(stamp_sums, i) / period_ns - rise(number_sums, i);
    errors.push_back(std::abs(late[i]));
  }
  if (!(period_ns > 0.0) || kNoise_medians * medianOf(std::move(errors)) > min_loss) return;
  double lost = 0.0;
  std::size_t next = width;
  for (std::size_t i = 0; i < size; ++i) {
    const auto around = late.begin() + static_cast<std::ptrdiff_t>(i);
    if (i >= next && late[i] >= min_loss && i + width <= size &&
        late[i] >= *std::max_element(around, around + static_cast<std::ptrdiff_t>(width))) {
      lost += std::round(late[i]);
      next = i + width;
    }
    numbers[i] += lost;
  }
}

// Mean of the stamps next to an end of the recording, moved to it at the mean rate: more exact than one
// stamp.
double endOf(const Times& times_ns, const std::vector<double>& numbers, bool last, double step_ns) {
  constexpr double kSteps = 10.0;
  const double rate_ns = static_cast<double>(times_ns.back() - times_ns.front()) / numbers.back();
  const auto size = static_cast<std::ptrdiff_t>(times_ns.size());
  const auto most = std::min<std::ptrdiff_t>(
      size, std::max<std::ptrdiff_t>(16, std::llround(kSteps * step_ns / std::max(rate_ns, 1.0))));
  const std::ptrdiff_t end = last ? size - 1 : 0;
  double sum_ns = 0.0;
  for (std::ptrdiff_t k = 0; k < most; ++k) {
    const auto i = static_cast<std::size_t>(last ? size - 1 - k : k);
    sum_ns += static_cast<double>(times_ns[i] - times_ns.front()) -
              rate_ns * (numbers[i] - numbers[static_cast<std::size_t>(end)]);
  }
  return sum_ns / static_cast<double>(most);
}

// The steadiest line through gates of a step's width at the stamps, over the samples' numbers.
std::vector<LinePoint> steadiestLine(const Times& times_ns, const StampSteps& steps,
                                     const std::vector<double>& numbers) {
  const auto gate = [&](std::size_t i) {
    const double stamp_ns = static_cast<double>(times_ns[i] - times_ns.front());
    const double half_ns = 0.5 * static_cast<double>(steps.at_ns(i) + kStampError_ns);
    return std::pair{stamp_ns - half_ns, stamp_ns + half_ns};
  };
  const std::size_t last = times_ns.size() - 1;
  const auto end = [&](bool is_last) {
    const auto [low, high] = gate(is_last ? last : 0);
    return std::clamp(endOf(times_ns, numbers, is_last, static_cast<double>(steps.largest_ns())), low, high);
  };
  TautString string({0.0, end(false)});
  for (std::size_t i = 1; i < last; ++i) {
    const auto [low, high] = gate(i);
    string.add(numbers[i], low, high);
  }
  const double end_ns = end(true);
  string.add(numbers[last], end_ns, end_ns);
  return string.finish();
}

// Replaces coarse stamps by times of a steady rate. `is_repeat`: samples that were sent twice.
CoarseStamps reconstruct(Times& times_ns, const std::vector<bool>& is_repeat, const StampOptions& options) {
  if (times_ns.size() < kFewestStamps) return {};
  const StampSteps steps(times_ns, is_repeat, options);
  CoarseStamps result{1e-9 * static_cast<double>(steps.largest_ns()), false};
  if (steps.largest_ns() == 0) return result;
  std::vector<double> numbers = sampleNumbers(times_ns, steps, options);
  addLost(times_ns, steps.largest_ns(), options.lost_periods, numbers);
  const std::vector<LinePoint> bends = steadiestLine(times_ns, steps, numbers);
  const double size = static_cast<double>(times_ns.size());
  const auto equal =
      std::ranges::count_if(Intervals(times_ns).all, [](std::int64_t each) { return each == 0; });
  if (static_cast<double>(bends.size()) > options.share_of_bends * size &&
      static_cast<double>(equal) < options.share_of_equal * size)
    return result;
  const std::int64_t start_ns = times_ns.front();
  std::size_t piece = 1;
  for (std::size_t i = 0; i < times_ns.size(); ++i) {
    while (piece + 1 < bends.size() && bends[piece].x < numbers[i]) ++piece;
    const LinePoint& from = bends[piece - 1];
    const double time_ns = from.y + (numbers[i] - from.x) * slope(from, bends[piece]);
    const std::int64_t before_ns = i > 0 ? times_ns[i - 1] : -kLatestTime_ns;
    times_ns[i] = std::max<std::int64_t>(start_ns + std::llround(time_ns), before_ns + 1);
  }
  result.reconstructed = true;
  return result;
}

bool sameValues(const ImuSample& a, const ImuSample& b) {
  return a.angular_rate_rad_s == b.angular_rate_rad_s && a.specific_force_m_s2 == b.specific_force_m_s2;
}

CoarseStamps reconstructAll(std::vector<ImuSample>& samples, const StampOptions& options) {
  Times times_ns;
  std::vector<bool> is_repeat;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    times_ns.push_back(samples[i].time_ns);
    is_repeat.push_back(i > 0 && samples[i].time_ns == samples[i - 1].time_ns &&
                        sameValues(samples[i], samples[i - 1]));
  }
  const CoarseStamps stamps = reconstruct(times_ns, is_repeat, options);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].time_ns = times_ns[i];
  return stamps;
}

constexpr auto kEarlier = [](const ImuSample& a, const ImuSample& b) { return a.time_ns < b.time_ns; };

// Samples of one of two sensors that are sampled separately.
std::vector<ImuSample> samplesOf(const std::vector<ImuSample>& samples, MeasuredBy sensor) {
  std::vector<ImuSample> own;
  for (const ImuSample& sample : samples) {
    if (sample.measured_by != MeasuredBy::Both && sample.measured_by != sensor) continue;
    own.push_back(sample);
    own.back().measured_by = sensor;
  }
  return own;
}

// Two sensors with separate times: equal stamps do not mean that both measured at the same time.
CoarseStamps reconstructApart(std::vector<ImuSample>& samples, const StampOptions& options) {
  std::vector<ImuSample> rates = samplesOf(samples, MeasuredBy::Gyroscope);
  std::vector<ImuSample> forces = samplesOf(samples, MeasuredBy::Accelerometer);
  const CoarseStamps of_rates = reconstructAll(rates, options), of_forces = reconstructAll(forces, options);
  const CoarseStamps stamps{std::max(of_rates.step_s, of_forces.step_s),
                            of_rates.reconstructed || of_forces.reconstructed};
  if (!stamps.reconstructed) return stamps;
  samples.clear();
  std::ranges::merge(rates, forces, std::back_inserter(samples), kEarlier);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool joins = kept > 0 && samples[kept - 1].time_ns == samples[i].time_ns &&
                       samples[kept - 1].measured_by == MeasuredBy::Gyroscope &&
                       samples[i].measured_by == MeasuredBy::Accelerometer;
    if (!joins) {
      samples[kept++] = samples[i];
      continue;
    }
    samples[kept - 1].specific_force_m_s2 = samples[i].specific_force_m_s2;
    samples[kept - 1].measured_by = MeasuredBy::Both;
  }
  samples.resize(kept);
  return stamps;
}

void leaveOutSecondClocks(const std::string& stream, std::int64_t first_ns, std::vector<ImuSample>& samples,
                          std::vector<RecordingFault>& faults) {
  const std::vector<SecondClock> clocks = findSecondClocks(samples);
  for (const SecondClock& clock : clocks) faults.push_back(faultOf(stream, first_ns, samples, clock));
  for (auto clock = clocks.rbegin(); clock != clocks.rend(); ++clock)
    samples.erase(samples.begin() + static_cast<std::ptrdiff_t>(clock->begin),
                  samples.begin() + static_cast<std::ptrdiff_t>(clock->end));
}

// Samples of a log that was written twice: equal stamps have equal values, too. With coarse stamps most
// values differ.
void leaveOutCopies(const std::string& stream, std::vector<ImuSample>& samples,
                    std::vector<RecordingFault>& faults, const StampOptions& options) {
  constexpr double kWorthSaying = 0.01;
  std::size_t equal = 0, copies = 0;
  const auto isCopy = [](const ImuSample& a, const ImuSample& b) {
    return a.time_ns == b.time_ns && a.measured_by == b.measured_by && sameValues(a, b);
  };
  for (std::size_t i = 1; i < samples.size(); ++i) {
    equal += samples[i].time_ns == samples[i - 1].time_ns ? 1 : 0;
    copies += isCopy(samples[i - 1], samples[i]) ? 1 : 0;
  }
  if (copies == 0 || static_cast<double>(copies) < options.share_of_copies * static_cast<double>(equal))
    return;
  if (static_cast<double>(copies) > kWorthSaying * static_cast<double>(samples.size()))
    faults.push_back({stream, FaultKind::BackwardTime, 0.0,
                      fmt::format("{}: {} written twice, with the same stamp and values: excluded", stream,
                                  counted(copies, "sample", "is", "are"))});
  samples.erase(std::unique(samples.begin(), samples.end(), isCopy), samples.end());
}

void leaveOutEqualStamps(const std::string& stream, std::int64_t first_ns, std::vector<ImuSample>& samples,
                         std::vector<RecordingFault>& faults) {
  std::size_t kept = 0, different = 0;
  std::int64_t at_ns = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool equal = kept > 0 && samples[kept - 1].time_ns == samples[i].time_ns;
    if (equal && !sameValues(samples[kept - 1], samples[i]) && different++ == 0) at_ns = samples[i].time_ns;
    if (!equal) samples[kept++] = samples[i];
  }
  samples.resize(kept);
  if (different == 0) return;
  const double at_s = secondsSince(first_ns, at_ns);
  faults.push_back(
      {stream, FaultKind::BackwardTime, at_s,
       fmt::format(
           "{}: {} the stamp of the sample before, but other values (the first at {:.3f} s): excluded",
           stream, counted(different, "sample", "has", "have"), at_s)});
}

}  // namespace

StampOptions::StampOptions() : StampOptions(kStampDefaults) {}

const OptionTable<StampOptions>& StampOptions::table() {
  static const OptionTable<StampOptions> table(kStampFields);
  return table;
}

CoarseStamps reconstructStamps(std::vector<ImuSample>& samples, const StampOptions& options) {
  const bool whole = std::ranges::all_of(
      samples, [](const ImuSample& sample) { return sample.measured_by == MeasuredBy::Both; });
  return whole ? reconstructAll(samples, options) : reconstructApart(samples, options);
}

RecordingFault faultOf(const std::string& stream, const CoarseStamps& stamps) {
  return {
      stream, FaultKind::Encoding, 0.0,
      fmt::format("Timestamps of IMU samples have steps of {:.3g} ms: a time offset is uncertain by half of "
                  "that{}.",
                  1e3 * stamps.step_s,
                  stamps.reconstructed ? ", and times are reconstructed from the samples' rate" : "")};
}

double putInOrder(const std::string& stream, std::int64_t first_ns, std::vector<ImuSample>& samples,
                  std::vector<RecordingFault>& faults, const StampOptions& options) {
  leaveOutSecondClocks(stream, first_ns, samples, faults);
  if (!std::ranges::is_sorted(samples, kEarlier)) {
    faults.push_back({stream, FaultKind::BackwardTime, 0.0, stream + ": samples out of order were sorted"});
    std::ranges::stable_sort(samples, kEarlier);
  }
  leaveOutCopies(stream, samples, faults, options);
  const CoarseStamps stamps = reconstructStamps(samples, options);
  if (stamps.step_s > 0.0) {
    faults.push_back(faultOf(stream, stamps));
    faults.back().text.insert(0, stream + ": ");
  }
  leaveOutEqualStamps(stream, first_ns, samples, faults);
  return stamps.step_s;
}

}  // namespace evical
