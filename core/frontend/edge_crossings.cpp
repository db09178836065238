#include "core/frontend/edge_crossings.h"

#include "core/base/time.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace evical {

std::optional<double> PixelLevel::had(const LevelBurst& burst) const {
  if (burst.rested_before) return 0.0;
  if (level_ < 0.0f || burst.cut_begin) return std::nullopt;
  return (burst.brighter ? level_ : 1.0f - level_) * static_cast<float>(whole_[burst.brighter]);
}

std::optional<PixelLevel::Middle> PixelLevel::pass(const LevelBurst& burst) {
  constexpr double kOneEnd = 0.5;  // events: nearer to an end than to the next event
  std::uint16_t& whole = whole_[burst.brighter];
  const std::optional<double> before = had(burst);
  const Middle own{0.5 * (burst.events - 1), burst.events};
  const bool from_end = before && *before < kOneEnd;
  if (burst.rested_after && from_end) whole = static_cast<std::uint16_t>(burst.events);
  if (whole == 0 || burst.events >= whole || (!burst.rested_after && !before)) {
    const bool at_end = burst.rested_after || (whole > 0 && burst.events >= whole);
    level_ = kUnknown;
    if (at_end) set(burst.brighter, 1.0);
    return own;
  }
  const double missing = whole - burst.events;
  const double fired = burst.rested_after ? missing : std::clamp(*before, 0.0, missing);
  set(burst.brighter, (fired + burst.events) / whole);
  const double event = 0.5 * (whole - 1) - fired;
  if (event < 0.0 || event > burst.events - 1) return std::nullopt;
  return Middle{event, whole};
}

void PixelLevel::step(bool brighter, int events) {
  if (level_ < 0.0f || whole_[brighter] == 0) return;
  const float part = static_cast<float>(events) / static_cast<float>(whole_[brighter]);
  level_ = std::clamp(level_ + (brighter ? part : -part), 0.0f, 1.0f);
}

namespace {

// A burst lasts from about 1.2 px before the edge is in the pixel's middle to 1.2 px after. An edge with
// constant deceleration that turns back D px after the middle leaves a pause of 2 sqrt(D - 1.2), in units of
// the time to turn from 1 px away, after a second half of sqrt(D) - sqrt(D - 1.2): 3.5 times as long for a D
// of 2 px, beyond which even blurred edges have crossed. Edges that do not turn leave longer pauses.
constexpr double kRestToHalfCrossing = 3.5;
// Limit for any pause: longer waits delay the windows for the slowest pixel.
constexpr double kLongestRest_s = 0.6;

// Pixels are in no order, and those of a sensor do not fit into a processor's cache: they are prefetched this
// many events ahead.
constexpr std::size_t kFetchedAhead = 16;

// True if the edge was out of the pixel's reach.
bool isRest(std::int64_t pause_ns, std::int64_t half_crossing_ns) {
  return pause_ns > nanosecondsFrom(kLongestRest_s) ||
         static_cast<double>(pause_ns) >= kRestToHalfCrossing * static_cast<double>(half_crossing_ns);
}

}  // namespace

// Sum of the burst's length, one rest or gap, and one check interval that may have just begun.
double longestHandOut_s(const BurstOptions& options) {
  return options.max_burst_s + std::max(kLongestRest_s, options.max_gap_s) + 2.0 * options.max_gap_s;
}

BurstExtractor::BurstExtractor(Resolution resolution_px, const BurstOptions& options)
    : resolution_px_(resolution_px),
      longest_gap_ns_(nanosecondsFrom(options.max_gap_s)),
      shortest_gap_ns_(nanosecondsFrom(options.min_gap_s)),
      longest_burst_ns_(nanosecondsFrom(options.max_burst_s)),
      check_interval_ns_(longest_gap_ns_),
      hand_out_ns_(nanosecondsFrom(longestHandOut_s(options))),
      gap_to_pace_(options.gap_to_pace),
      min_events_(options.min_events),
      single_events_(options.single_events),
      pixels_(static_cast<std::size_t>(resolution_px.pixelCount())),
      times_ns_(pixels_.size(), KeptTimes{}),
      complete_until_ns_(std::numeric_limits<std::int64_t>::min()) {}

std::uint32_t BurstExtractor::indexOf(const Event& event) const {
  return event.y_px * static_cast<std::uint32_t>(resolution_px_.width_px) + event.x_px;
}

void BurstExtractor::fetch(std::uint32_t index) const {
  __builtin_prefetch(pixels_.data() + index, 1);
  __builtin_prefetch(times_ns_.data() + index, 1);
}

void BurstExtractor::start(std::uint32_t index, const Event& event) {
  Pixel& pixel = pixels_[index];
  // A pixel with a current burst is already in the queue.
  if (pixel.events == 0) checks_.push_back({index, event.time_ns + check_interval_ns_});
  pixel.first_ns = event.time_ns;
  pixel.length_ns = 0;
  pixel.events = 1;
  pixel.kept = 1;
  pixel.stride_log2 = 0;
  pixel.brighter = event.brighter;
}

void BurstExtractor::extend(std::uint32_t index, const Event& event) {
  Pixel& pixel = pixels_[index];
  const unsigned position = pixel.events;
  pixel.length_ns = static_cast<std::int32_t>(event.time_ns - pixel.first_ns);
  if (pixel.events < std::numeric_limits<std::uint16_t>::max()) ++pixel.events;
  if (position & ((1u << pixel.stride_log2) - 1u)) return;
  KeptTimes& times_ns = times_ns_[index];
  if (pixel.kept == kKeptTimes) {
    for (std::size_t i = 0; i < kKeptTimes / 2; ++i) times_ns[i] = times_ns[2 * i];
    pixel.kept = kKeptTimes / 2;
    ++pixel.stride_log2;
    if (position & ((1u << pixel.stride_log2) - 1u)) return;
  }
  times_ns[pixel.kept++] = pixel.length_ns;
}

// Index of the first event of the burst itself: events before it may be earlier noise. Same criterion as in
// pausedAt, backwards in time.
int BurstExtractor::ownBegin(const Burst& burst) const {
  int begin = 0;
  for (const int last = burst.pixel.kept - 1; begin + 3 <= last; ++begin) {
    const double gap_ns = burst.times_ns[begin + 1] - burst.times_ns[begin];
    const double rest_ns = burst.times_ns[last] - burst.times_ns[begin + 1];
    if (gap_ns <= static_cast<double>(shortest_gap_ns_) ||
        gap_ns * (last - begin - 1) <= gap_to_pace_ * rest_ns)
      break;
  }
  return begin;
}

std::int64_t BurstExtractor::Burst::timeOf_ns(double kept_event) const {
  const auto below = static_cast<std::size_t>(std::clamp(static_cast<int>(kept_event), 0, pixel.kept - 1));
  const std::size_t above = std::min<std::size_t>(below + 1, pixel.kept - 1u);
  const double part = std::clamp(kept_event - static_cast<double>(below), 0.0, 1.0);
  // Events are in order, so this rounds to the nearest.
  return pixel.first_ns + times_ns[below] +
         static_cast<std::int64_t>(part * (times_ns[above] - times_ns[below]) + 0.5);
}

void BurstExtractor::end(std::uint32_t index, std::int64_t now_ns, std::vector<EdgeCrossing>& bursts) {
  Pixel& pixel = pixels_[index];
  const Burst burst{pixel, times_ns_[index]};
  const auto handOut = [&](std::int64_t time_ns, int events) {
    const auto width = static_cast<std::uint32_t>(resolution_px_.width_px);
    bursts.push_back({time_ns, pixel.length_ns, static_cast<std::uint16_t>(index % width),
                      static_cast<std::uint16_t>(index / width), static_cast<std::uint16_t>(events),
                      pixel.brighter});
  };
  if (pixel.events < min_events_) {
    if (!pausedAt(pixel, now_ns)) pixel.level.step(pixel.brighter, pixel.events);
    if (single_events_) handOut(burst.timeOf_ns(0.5 * (pixel.kept - 1)), 0);
    return;
  }
  const int first = ownBegin(burst), stride = 1 << pixel.stride_log2;
  const std::int64_t begin_ns = pixel.first_ns + burst.times_ns[static_cast<std::size_t>(first)];
  const std::int64_t last_ns = pixel.last_ns();
  const std::int64_t median_ns = burst.timeOf_ns(0.5 * (first + pixel.kept - 1));
  const std::int64_t before_ns = first > 0 ? burst.timeOf_ns(first - 1) : pixel.quiet_since_ns;
  const std::optional<PixelLevel::Middle> middle = pixel.level.pass(
      {pixel.brighter, pixel.events - first * stride, first > 0,
       isRest(begin_ns - before_ns, median_ns - begin_ns), isRest(now_ns - last_ns, last_ns - median_ns)});
  pixel.quiet_since_ns = last_ns;
  if (!middle) return;
  handOut(burst.timeOf_ns(first + middle->event / stride), middle->whole_events);
}

bool BurstExtractor::pausedAt(const Pixel& pixel, std::int64_t time_ns) const {
  const std::int64_t since_first_ns = time_ns - pixel.first_ns, gap_ns = since_first_ns - pixel.length_ns;
  if (gap_ns > longest_gap_ns_ || since_first_ns > longest_burst_ns_) return true;
  if (gap_ns <= shortest_gap_ns_ || pixel.events < 3) return false;
  // Longer than this many mean intervals.
  return static_cast<double>(gap_ns) * (pixel.events - 1) > gap_to_pace_ * pixel.length_ns;
}

bool BurstExtractor::restedAt(const Burst& burst, std::int64_t time_ns) const {
  const std::int64_t median_ns = burst.timeOf_ns(0.5 * (ownBegin(burst) + burst.pixel.kept - 1));
  const std::int64_t last_ns = burst.pixel.last_ns();
  return isRest(time_ns - last_ns, last_ns - median_ns);
}

void BurstExtractor::endPaused(std::int64_t now_ns, std::vector<EdgeCrossing>& bursts) {
  while (!checks_.empty() && checks_.front().at_ns <= now_ns) {
    const Check check = checks_.front();
    checks_.pop_front();
    if (checks_.size() > kFetchedAhead) fetch(checks_[kFetchedAhead].pixel);
    Pixel& pixel = pixels_[check.pixel];
    if (pausedAt(pixel, now_ns) && restedAt({pixel, times_ns_[check.pixel]}, now_ns)) {
      end(check.pixel, now_ns, bursts);
      pixel.events = 0;
    } else {
      checks_.push_back({check.pixel, now_ns + check_interval_ns_});
    }
  }
}

void BurstExtractor::add(EventSpan events, std::vector<EdgeCrossing>& bursts) {
  if (events.empty()) return;
  std::int64_t next_check_ns =
      checks_.empty() ? events.front().time_ns + check_interval_ns_ : checks_.front().at_ns;
  for (std::size_t k = 0; k < events.size(); ++k) {
    const Event& event = events[k];
    if (event.time_ns >= next_check_ns) {
      endPaused(event.time_ns, bursts);
      next_check_ns = event.time_ns + check_interval_ns_ / 8;
    }
    if (k + kFetchedAhead < events.size()) fetch(indexOf(events[k + kFetchedAhead]));
    const std::uint32_t index = indexOf(event);
    const Pixel& pixel = pixels_[index];
    if (pixel.events > 0 && pixel.brighter == event.brighter && !pausedAt(pixel, event.time_ns)) {
      extend(index, event);
      continue;
    }
    if (pixel.events > 0) end(index, event.time_ns, bursts);
    start(index, event);
  }
  event_count_ += events.size();
  last_event_ns_ = events.back().time_ns;
  complete_until_ns_ = last_event_ns_ - hand_out_ns_;
}

void BurstExtractor::finish(std::vector<EdgeCrossing>& bursts) {
  for (const Check& check : checks_) end(check.pixel, last_event_ns_, bursts);
  for (const Check& check : checks_) pixels_[check.pixel].events = 0;
  checks_.clear();
  complete_until_ns_ = std::numeric_limits<std::int64_t>::max();
}

void PolarityDelayFit::add(double speed_px_s, double radius_offset_px) {
  constexpr double kSlow_px_s = 20.0;  // bursts of slower edges are displaced (docs/maths.md, 9.1)
  if (!(speed_px_s >= kSlow_px_s)) return;
  count_ += 1.0;
  speed_ += speed_px_s;
  offset_ += radius_offset_px;
  speed2_ += speed_px_s * speed_px_s;
  offset2_ += radius_offset_px * radius_offset_px;
  product_ += speed_px_s * radius_offset_px;
}

std::optional<PolarityDelay> PolarityDelayFit::result(CircleShade shade) const {
  constexpr double kMinWindows = 20.0, kMinSpread_px_s = 5.0;
  if (count_ < kMinWindows) return std::nullopt;
  const double spread = speed2_ - speed_ * speed_ / count_;
  if (!(spread > count_ * kMinSpread_px_s * kMinSpread_px_s)) return std::nullopt;
  const double slope_s = (product_ - speed_ * offset_ / count_) / spread;
  const double scatter2 = std::max(0.0, offset2_ - offset_ * offset_ / count_ - slope_s * slope_s * spread);
  const double sigma_s = std::sqrt(scatter2 / ((count_ - 2.0) * spread));
  const double sign = shade == CircleShade::Dark ? 1.0 : -1.0;
  return PolarityDelay{2.0 * sign * slope_s, 2.0 * sigma_s};
}

}  // namespace evical
