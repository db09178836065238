// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/burst_band.h"

#include "core/base/time.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace evical::ui {
namespace {

constexpr std::int64_t kKept_ns = 10'000'000'000;
constexpr std::int64_t kBackwards_ns = 200'000'000;  // margin for steps back without a restart
constexpr std::int64_t kChunk_ns = 50'000'000;
constexpr std::int64_t kEverything = std::numeric_limits<std::int64_t>::max();

}  // namespace

BurstBand::BurstBand(std::shared_ptr<const EventCache> cache, Resolution resolution_px,
                     const BurstOptions& options)
    : cache_(std::move(cache)),
      resolution_px_(resolution_px),
      options_(options),
      lead_ns_(nanosecondsFrom(options.max_burst_s + options.max_gap_s)),
      lag_ns_(nanosecondsFrom(longestHandOut_s(options))) {}

void BurstBand::restart(std::int64_t begin_ns) {
  extractor_.emplace(resolution_px_, options_);
  history_ = BurstHistory();
  covered_from_ns_ = begin_ns - kBackwards_ns;
  fed_until_ns_ = covered_from_ns_ - lead_ns_;
  running_ = true;
}

void BurstBand::feedUntil(std::int64_t end_ns) {
  while (fed_until_ns_ < end_ns) {
    const std::int64_t next_ns = std::min(fed_until_ns_ + kChunk_ns, end_ns);
    events_.clear();
    bursts_.clear();
    cache_->gather(fed_until_ns_, next_ns, events_);
    extractor_->add(events_, bursts_);
    history_.add(bursts_);
    fed_until_ns_ = next_ns;
  }
}

bool BurstBand::cover(std::int64_t begin_ns, std::int64_t end_ns) {
  const std::int64_t complete_ns = cache_->completeUntil_ns();
  const bool finished = complete_ns == kEverything;
  const bool far_ahead = fed_until_ns_ < begin_ns - lead_ns_ - kBackwards_ns;
  if (!running_ || begin_ns < covered_from_ns_ || (extractor_ && far_ahead)) restart(begin_ns);
  if (!extractor_) return true;  // already at the end
  const std::int64_t wanted_ns = end_ns + lag_ns_;
  feedUntil(std::min(wanted_ns, complete_ns));
  if (finished && fed_until_ns_ > cache_->lastEvent_ns()) {
    bursts_.clear();
    extractor_->finish(bursts_);
    history_.add(bursts_);
    extractor_.reset();
  }
  if (covered_from_ns_ < fed_until_ns_ - kKept_ns) {
    covered_from_ns_ = fed_until_ns_ - kKept_ns;
    history_.dropBefore(covered_from_ns_);
  }
  return finished || complete_ns >= wanted_ns;
}

}  // namespace evical::ui
