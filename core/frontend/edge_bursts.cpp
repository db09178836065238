#include "core/frontend/edge_bursts.h"

#include "core/base/time.h"

#include <algorithm>
#include <limits>

namespace evical {

BurstExtractor::BurstExtractor(Resolution resolution_px, const BurstOptions& options)
    : resolution_px_(resolution_px),
      longest_gap_ns_(nanosecondsFrom(options.longest_gap_s)),
      shortest_gap_ns_(nanosecondsFrom(options.shortest_gap_s)),
      longest_burst_ns_(nanosecondsFrom(options.longest_burst_s)),
      check_interval_ns_(longest_gap_ns_),
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

void BurstExtractor::end(Pixel& pixel, std::uint32_t index, std::vector<EdgeBurst>& bursts) const {
  if (pixel.events < least_events_) return;
  const int first = ownBegin(pixel), n = pixel.kept - first;
  const std::int32_t twice_median = pixel.times_ns[first + (n - 1) / 2] + pixel.times_ns[first + n / 2];
  const auto width = static_cast<std::uint32_t>(resolution_px_.width_px);
  bursts.push_back({pixel.first_ns + twice_median / 2,
                    static_cast<std::int32_t>(pixel.last_ns - pixel.first_ns),
                    static_cast<std::uint16_t>(index % width), static_cast<std::uint16_t>(index / width),
                    pixel.events, pixel.brighter});
}

bool BurstExtractor::pausedAt(const Pixel& pixel, std::int64_t time_ns) const {
  const std::int64_t gap_ns = time_ns - pixel.last_ns;
  if (gap_ns > longest_gap_ns_ || time_ns - pixel.first_ns > longest_burst_ns_) return true;
  if (gap_ns <= shortest_gap_ns_ || pixel.events < 3) return false;
  const double pace_ns = static_cast<double>(pixel.last_ns - pixel.first_ns) / (pixel.events - 1);
  return static_cast<double>(gap_ns) > gap_to_pace_ * pace_ns;
}

void BurstExtractor::endPaused(std::int64_t now_ns, std::vector<EdgeBurst>& bursts) {
  while (!checks_.empty() && checks_.front().at_ns <= now_ns) {
    const Check check = checks_.front();
    checks_.pop_front();
    Pixel& pixel = pixels_[check.pixel];
    if (pausedAt(pixel, now_ns)) {
      end(pixel, check.pixel, bursts);
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
    if (pixel.events > 0) end(pixel, index, bursts);
    start(pixel, index, event);
  }
  event_count_ += events.size();
  // A burst is handed out at the latest one gap, one check interval and its own length after its median.
  complete_until_ns_ = events.back().time_ns - longest_burst_ns_ - longest_gap_ns_ - 2 * check_interval_ns_;
}

void BurstExtractor::finish(std::vector<EdgeBurst>& bursts) {
  for (const Check& check : checks_) end(pixels_[check.pixel], check.pixel, bursts);
  for (const Check& check : checks_) pixels_[check.pixel].events = 0;
  checks_.clear();
  complete_until_ns_ = std::numeric_limits<std::int64_t>::max();
}

}  // namespace evical
