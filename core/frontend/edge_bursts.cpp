#include "core/frontend/edge_bursts.h"

#include "core/base/time.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace evical {
namespace {

// A burst lasts from some 1.2 px before the edge is in the pixel's middle to 1.2 px after. An edge that slows
// down evenly and turns back D px after the middle leaves a pause of 2 sqrt(D - 1.2), in units of the time to
// turn from 1 px away, after a second half of sqrt(D) - sqrt(D - 1.2): 3.5 times as long where D is 2 px, from where
// on even blurred edges have crossed. Edges that do not turn leave longer pauses.
constexpr double kRestToHalfCrossing = 3.5;
// Whatever the pause is compared with: who waits longer holds up the windows for the slowest pixel.
constexpr double kLongestRest_s = 0.6;

// The edge was out of the pixel's reach.
bool isRest(std::int64_t pause_ns, std::int64_t half_crossing_ns) {
  return pause_ns > nanosecondsFrom(kLongestRest_s) ||
         static_cast<double>(pause_ns) >= kRestToHalfCrossing * static_cast<double>(half_crossing_ns);
}

}  // namespace

// Its own length, one rest or gap, and one check interval that may have just begun.
double longestHandOut_s(const BurstOptions& options) {
  return options.longest_burst_s + std::max(kLongestRest_s, options.longest_gap_s) +
         2.0 * options.longest_gap_s;
}

BurstExtractor::BurstExtractor(Resolution resolution_px, const BurstOptions& options)
    : resolution_px_(resolution_px),
      longest_gap_ns_(nanosecondsFrom(options.longest_gap_s)),
      shortest_gap_ns_(nanosecondsFrom(options.shortest_gap_s)),
      longest_burst_ns_(nanosecondsFrom(options.longest_burst_s)),
      check_interval_ns_(longest_gap_ns_),
      hand_out_ns_(nanosecondsFrom(longestHandOut_s(options))),
      gap_to_pace_(options.gap_to_pace),
      least_events_(options.least_events),
      pixels_(static_cast<std::size_t>(resolution_px.pixelCount())),
      complete_until_ns_(std::numeric_limits<std::int64_t>::min()) {}

void BurstExtractor::start(Pixel& pixel, std::uint32_t index, const Event& event) {
  // A pixel that has a burst under way already waits in the queue.
  if (pixel.events == 0) checks_.push_back({index, event.time_ns + check_interval_ns_});
  pixel.first_ns = pixel.last_ns = event.time_ns;
  pixel.events = 1;
  pixel.kept = 1;
  pixel.stride_log2 = 0;
  pixel.brighter = event.brighter;
  pixel.times_ns[0] = 0;
}

void BurstExtractor::extend(Pixel& pixel, const Event& event) {
  const unsigned position = pixel.events;
  pixel.last_ns = event.time_ns;
  if (pixel.events < std::numeric_limits<std::uint16_t>::max()) ++pixel.events;
  if (position & ((1u << pixel.stride_log2) - 1u)) return;
  if (pixel.kept == kKeptTimes) {
    for (int i = 0; i < kKeptTimes / 2; ++i) pixel.times_ns[i] = pixel.times_ns[2 * i];
    pixel.kept = kKeptTimes / 2;
    ++pixel.stride_log2;
    if (position & ((1u << pixel.stride_log2) - 1u)) return;
  }
  pixel.times_ns[pixel.kept++] = static_cast<std::int32_t>(event.time_ns - pixel.first_ns);
}

// A burst's first events may be noise from long before it: what pausedAt asks of
// the next event, asked backwards.
int BurstExtractor::ownBegin(const Pixel& pixel) const {
  int begin = 0;
  for (const int last = pixel.kept - 1; begin + 3 <= last; ++begin) {
    const double gap_ns = pixel.times_ns[begin + 1] - pixel.times_ns[begin];
    const double pace_ns =
        static_cast<double>(pixel.times_ns[last] - pixel.times_ns[begin + 1]) / (last - begin - 1);
    if (gap_ns <= static_cast<double>(shortest_gap_ns_) || gap_ns <= gap_to_pace_ * pace_ns) break;
  }
  return begin;
}

std::int64_t BurstExtractor::Pixel::timeOf_ns(double kept_event) const {
  const auto below = static_cast<std::size_t>(std::clamp(static_cast<int>(kept_event), 0, kept - 1));
  const std::size_t above = std::min<std::size_t>(below + 1, kept - 1u);
  const double part = std::clamp(kept_event - static_cast<double>(below), 0.0, 1.0);
  return first_ns + times_ns[below] + std::llround(part * (times_ns[above] - times_ns[below]));
}

void BurstExtractor::end(Pixel& pixel, std::uint32_t index, std::int64_t now_ns,
                         std::vector<EdgeBurst>& bursts) const {
  if (pixel.events < least_events_) {
    if (!pausedAt(pixel, now_ns)) pixel.level.step(pixel.brighter, pixel.events);
    return;
  }
  const int first = ownBegin(pixel), stride = 1 << pixel.stride_log2;
  const std::int64_t begin_ns = pixel.first_ns + pixel.times_ns[static_cast<std::size_t>(first)];
  const std::int64_t median_ns = pixel.timeOf_ns(0.5 * (first + pixel.kept - 1));
  const std::int64_t before_ns = first > 0 ? pixel.timeOf_ns(first - 1) : pixel.quiet_since_ns;
  const std::optional<PixelLevel::Middle> middle =
      pixel.level.pass({pixel.brighter, pixel.events - first * stride, first > 0,
                        isRest(begin_ns - before_ns, median_ns - begin_ns),
                        isRest(now_ns - pixel.last_ns, pixel.last_ns - median_ns)});
  pixel.quiet_since_ns = pixel.last_ns;
  if (!middle) return;
  const auto width = static_cast<std::uint32_t>(resolution_px_.width_px);
  bursts.push_back({pixel.timeOf_ns(first + middle->event / stride),
                    static_cast<std::int32_t>(pixel.last_ns - pixel.first_ns),
                    static_cast<std::uint16_t>(index % width), static_cast<std::uint16_t>(index / width),
                    static_cast<std::uint16_t>(middle->whole_events), pixel.brighter});
}

bool BurstExtractor::pausedAt(const Pixel& pixel, std::int64_t time_ns) const {
  const std::int64_t gap_ns = time_ns - pixel.last_ns;
  if (gap_ns > longest_gap_ns_ || time_ns - pixel.first_ns > longest_burst_ns_) return true;
  if (gap_ns <= shortest_gap_ns_ || pixel.events < 3) return false;
  const double pace_ns = static_cast<double>(pixel.last_ns - pixel.first_ns) / (pixel.events - 1);
  return static_cast<double>(gap_ns) > gap_to_pace_ * pace_ns;
}

bool BurstExtractor::restedAt(const Pixel& pixel, std::int64_t time_ns) const {
  const std::int64_t median_ns = pixel.timeOf_ns(0.5 * (ownBegin(pixel) + pixel.kept - 1));
  return isRest(time_ns - pixel.last_ns, pixel.last_ns - median_ns);
}

void BurstExtractor::endPaused(std::int64_t now_ns, std::vector<EdgeBurst>& bursts) {
  while (!checks_.empty() && checks_.front().at_ns <= now_ns) {
    const Check check = checks_.front();
    checks_.pop_front();
    Pixel& pixel = pixels_[check.pixel];
    if (pausedAt(pixel, now_ns) && restedAt(pixel, now_ns)) {
      end(pixel, check.pixel, now_ns, bursts);
      pixel.events = 0;
    } else {
      checks_.push_back({check.pixel, now_ns + check_interval_ns_});
    }
  }
}

void BurstExtractor::add(EventSpan events, std::vector<EdgeBurst>& bursts) {
  if (events.empty()) return;
  const auto width = static_cast<std::uint32_t>(resolution_px_.width_px);
  std::int64_t next_check_ns =
      checks_.empty() ? events.front().time_ns + check_interval_ns_ : checks_.front().at_ns;
  for (const Event& event : events) {
    if (event.time_ns >= next_check_ns) {
      endPaused(event.time_ns, bursts);
      next_check_ns = event.time_ns + check_interval_ns_ / 8;
    }
    const std::uint32_t index = event.y_px * width + event.x_px;
    Pixel& pixel = pixels_[index];
    if (pixel.events > 0 && pixel.brighter == event.brighter && !pausedAt(pixel, event.time_ns)) {
      extend(pixel, event);
      continue;
    }
    if (pixel.events > 0) end(pixel, index, event.time_ns, bursts);
    start(pixel, index, event);
  }
  event_count_ += events.size();
  last_event_ns_ = events.back().time_ns;
  complete_until_ns_ = last_event_ns_ - hand_out_ns_;
}

void BurstExtractor::finish(std::vector<EdgeBurst>& bursts) {
  for (const Check& check : checks_) end(pixels_[check.pixel], check.pixel, last_event_ns_, bursts);
  for (const Check& check : checks_) pixels_[check.pixel].events = 0;
  checks_.clear();
  complete_until_ns_ = std::numeric_limits<std::int64_t>::max();
}

}  // namespace evical
