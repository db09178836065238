#include "core/data/stamp_batches.h"

#include "core/base/time.h"
#include "core/numerics/robust.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace evical {

std::string StampBatches::text() const {
  return fmt::format(
      "samples are stamped in batches of about {}, {:.3g} ms apart and followed by {:.3g} ms "
      "without samples: "
      "on arrival instead of at the time of measurement",
      samples, 1e3 * interval_s, 1e3 * pause_s);
}

std::optional<StampBatches> findStampBatches(std::span<const std::int64_t> times_ns) {
  if (times_ns.size() < 3) return std::nullopt;
  std::vector<double> intervals_s;
  for (std::size_t k = 1; k < times_ns.size(); ++k)
    intervals_s.push_back(secondsSince(times_ns[k - 1], times_ns[k]));
  // Batches of 5 that were stamped on arrival displaced circles by 220 times their noise. Batches of up to
  // 200 are detected, if gaps of ten periods cover half of the time or more; fewer gaps are lost samples.
  // Chosen far from jitter, not measured.
  constexpr double kGap_periods = 10.0, kMinTime = 0.5;
  constexpr std::size_t kLargestBatch = 200;
  const double period_s = medianOf(intervals_s);
  std::size_t gaps = 0;
  double in_gaps_s = 0.0;
  for (const double interval_s : intervals_s) {
    if (interval_s <= kGap_periods * period_s) continue;
    ++gaps;
    in_gaps_s += interval_s;
  }
  const double whole_s = secondsSince(times_ns.front(), times_ns.back());
  if (gaps == 0 || gaps * kLargestBatch < intervals_s.size() || in_gaps_s < kMinTime * whole_s)
    return std::nullopt;
  return StampBatches{times_ns.size() / gaps, period_s, in_gaps_s / static_cast<double>(gaps)};
}

}  // namespace evical
