#include "core/frames/flash_gathering.h"

#include "core/base/time.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace evical {

// A turn is detected as soon as the new events outweigh the old ones in the smoothed bins: after half of
// these if a pixel fires continuously, immediately if it fires in short bursts.
bool HalfPeriods::add(double balance) {
  constexpr double kClear = 0.15;  // relative to the maximum of the last two periods
  last_[count_ % kSmoothed] = balance;
  const double smooth = std::accumulate(last_.begin(), last_.end(), 0.0);
  heights_[count_ % heights_.size()] = std::abs(smooth);
  ++count_;
  const double height = *std::max_element(heights_.begin(), heights_.end());
  const int sign = smooth > kClear * height ? 1 : smooth < -kClear * height ? -1 : 0;
  return sign != 0 && std::exchange(sign_, sign) == -sign;
}

namespace {

constexpr int kMostParts = 16;        // per slot
constexpr double kLongestHalf = 1.2;  // periods: in a longer one the light was out of sight
constexpr int kLongestPause = 3;      // periods without any event

}  // namespace

FlashGathering::FlashGathering(Resolution resolution_px, double period_s, double slot_s, Sink sink)
    : resolution_px_(resolution_px),
      period_ns_(nanosecondsFrom(period_s)),
      bin_ns_(std::max<std::int64_t>(1, period_ns_ / HalfPeriods::kBinsPerPeriod)),
      slot_ns_(nanosecondsFrom(std::max(slot_s, period_s))),
      part_ns_(slot_ns_ / kMostParts),
      sink_(std::move(sink)) {}

void FlashGathering::start(std::int64_t time_ns) {
  handOut();
  half_periods_ = {};
  pending_.clear();
  balance_ = 0.0;
  bin_end_ns_ = time_ns + bin_ns_;
  current_ = {time_ns, time_ns, 0,
              std::vector<std::uint16_t>(static_cast<std::size_t>(resolution_px_.pixelCount()))};
  whole_ = false;
  started_ = true;
}

void FlashGathering::add(const Event& event) {
  if (!started_ || event.time_ns > bin_end_ns_ + kLongestPause * period_ns_) start(event.time_ns);
  while (event.time_ns >= bin_end_ns_) closeBin();
  balance_ += event.brighter ? 1.0 : -1.0;
  pending_.push_back(event);
}

void FlashGathering::closeBin() {
  const bool turned = half_periods_.add(std::exchange(balance_, 0.0));
  const std::int64_t settled_ns = bin_end_ns_ - HalfPeriods::kTurn_bins * bin_ns_;
  for (; !pending_.empty() && pending_.front().time_ns < settled_ns; pending_.pop_front())
    current_.add(pending_.front(), resolution_px_.width_px);
  if (turned) endHalfPeriod(settled_ns);
  bin_end_ns_ += bin_ns_;
}

void FlashGathering::endHalfPeriod(std::int64_t at_ns) {
  FlashCounts half = std::move(current_);
  half.end_ns = at_ns;
  half.half_periods = 1;
  current_ = {at_ns, at_ns, 0, std::vector<std::uint16_t>(half.counts.size())};
  const bool fits = std::exchange(whole_, true) && static_cast<double>(at_ns - half.begin_ns) <
                                                       kLongestHalf * static_cast<double>(period_ns_);
  if (!fits) return handOut();
  if (!slot_.empty() && slot_.back().end_ns - slot_.back().begin_ns < part_ns_)
    slot_.back() = sumOf(std::array{std::move(slot_.back()), std::move(half)});
  else
    slot_.push_back(std::move(half));
  if (at_ns - slot_.front().begin_ns >= slot_ns_) handOut();
}

// A single half period may be half as bright as the next.
void FlashGathering::handOut() {
  int half_periods = 0;
  for (const FlashCounts& part : slot_) half_periods += part.half_periods;
  if (half_periods >= 2) sink_(slot_);
  slot_.clear();
}

}  // namespace evical
