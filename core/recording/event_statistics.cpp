#include "core/recording/event_statistics.h"

#include "core/base/nearest_name.h"
#include "core/base/number.h"
#include "core/base/time.h"
#include "core/numerics/robust.h"
#include "core/recording/stray_stamps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

namespace evical {
namespace {

constexpr Resolution kLargestGuess_px = {2048,
                                         2048};  // if the file does not state it; no event sensor has more
constexpr std::size_t kMaxNamedPixels = 8;
constexpr std::int64_t kLongStep_ns = 3600 * kSecond_ns;
constexpr std::uint64_t kFewStrays = kEventStamps.enough;

}  // namespace

EventStatistics::EventStatistics(const StreamInfo& info, const InspectionOptions& options)
    : options_(options), intervals_(kIntervals) {
  numbers_.info = info;
  counted_px_ = info.resolution_px.known() ? info.resolution_px : kLargestGuess_px;
  counted_px_.width_px = std::min(counted_px_.width_px, 2 * kLargestGuess_px.width_px);
  max_rows_ = std::min(counted_px_.height_px, 2 * kLargestGuess_px.height_px);
  counted_px_.height_px = 0;
}

// Number of counted rows, with this one if the sensor may have it: memory grows with the events' coordinates,
// not with the size that a file claims.
unsigned EventStatistics::rowsWith(unsigned y_px) {
  if (y_px < static_cast<unsigned>(max_rows_)) {
    counted_px_.height_px = std::max(counted_px_.height_px, static_cast<int>(y_px) + 1);
    pixels_.resize(static_cast<std::size_t>(counted_px_.pixelCount()));
  }
  return static_cast<unsigned>(counted_px_.height_px);
}

void EventStatistics::add(EventSpan events) {
  if (events.empty()) return;
  stamp_step_.add(events);
  if (numbers_.count == 0) numbers_.first_ns = numbers_.last_ns = events.front().time_ns;
  const auto width = static_cast<unsigned>(counted_px_.width_px);
  auto height = static_cast<unsigned>(counted_px_.height_px);
  const auto gap_ns = nanosecondsFrom(options_.event_gap_s);
  const std::int64_t time_unit_ns = numbers_.info.time_unit_ns;
  std::int64_t previous_ns = numbers_.last_ns;
  unsigned largest_x = 0, largest_y = 0;
  for (const Event& event : events) {
    const std::int64_t interval_ns = event.time_ns - previous_ns;
    if (interval_ns < 0 || interval_ns > gap_ns)
      checkInterval(previous_ns, event.time_ns,
                    numbers_.count + static_cast<std::uint64_t>(&event - events.data()));
    numbers_.largest_gap_ns = std::max(numbers_.largest_gap_ns, interval_ns);
    previous_ns = event.time_ns;
    numbers_.on += event.brighter ? 1 : 0;
    numbers_.sum_x += event.x_px;
    numbers_.sum_y += event.y_px;
    numbers_.sum_t += static_cast<std::uint64_t>(event.time_ns / time_unit_ns);
    largest_x = std::max<unsigned>(largest_x, event.x_px);
    largest_y = std::max<unsigned>(largest_y, event.y_px);
    if (event.y_px >= height) height = rowsWith(event.y_px);
    if (event.x_px < width && event.y_px < height) {
      Pixel& pixel = pixels_[static_cast<std::size_t>(event.y_px) * width + event.x_px];
      const auto time_us = static_cast<std::uint32_t>(event.time_ns / 1000);
      const std::uint32_t interval = (time_us - pixel.last_us) / kInterval_us;
      if (pixel.events > 0 && interval < kIntervals) ++intervals_[interval];
      pixel.last_us = time_us;
      ++pixel.events;
    } else {
      ++outside_;
    }
  }
  numbers_.last_ns = previous_ns;
  numbers_.count += events.size();
  numbers_.seen_px.width_px = std::max(numbers_.seen_px.width_px, static_cast<int>(largest_x) + 1);
  numbers_.seen_px.height_px = std::max(numbers_.seen_px.height_px, static_cast<int>(largest_y) + 1);
}

// A few events before or after a long step are strays, which do not extend the recording.
void EventStatistics::checkInterval(std::int64_t previous_ns, std::int64_t time_ns, std::uint64_t before) {
  if (time_ns - previous_ns > kLongStep_ns && before < kFewStrays) numbers_.first_ns = time_ns;
  if (std::abs(time_ns - previous_ns) > kLongStep_ns) last_step_ = {before, previous_ns};
  const double step_ms = 1e-6 * static_cast<double>(time_ns - previous_ns);
  if (time_ns >= previous_ns) {
    addFault(FaultKind::Gap, previous_ns, fmt::format("No events for {:.3f} ms.", step_ms));
    return;
  }
  ++numbers_.backward_steps;
  const char* reset = previous_ns - time_ns > kClockReset_ns ? "; the clock was reset" : "";
  addFault(FaultKind::BackwardTime, previous_ns,
           fmt::format("Time runs backwards by {:.3f} ms{}.", -step_ms, reset));
}

void EventStatistics::addFault(FaultKind kind, std::int64_t at_ns, std::string text) {
  const auto alike = [kind](const RecordingFault& fault) { return fault.kind == kind; };
  if (std::count_if(faults_.begin(), faults_.end(), alike) >= kMostAlikeFaults) return;
  faults_.push_back({numbers_.info.name, kind, secondsSince(numbers_.first_ns, at_ns), std::move(text)});
}

void EventStatistics::finish(StreamSummary& summary, std::vector<RecordingFault>& faults) {
  numbers_.off = numbers_.count - numbers_.on;
  if (last_step_.count > 0 && numbers_.count - last_step_.count < kFewStrays)
    numbers_.last_ns = last_step_.time_ns;
  const double duration_s = secondsSince(numbers_.first_ns, numbers_.last_ns);
  if (duration_s > 0.0) numbers_.rate_hz = static_cast<double>(numbers_.count) / duration_s;
  numbers_.shortest_interval_s = shortestInterval_s();
  numbers_.info = summary.info;
  summary = numbers_;
  faults.insert(faults.end(), faults_.begin(), faults_.end());
  const std::string& name = summary.info.name;
  if (summary.count == 0) faults.push_back({name, FaultKind::Empty, 0.0, "The stream has no events."});
  if (outside_ > 0 && summary.info.resolution_px.known()) {
    faults.push_back(
        {name, FaultKind::Outside, 0.0,
         fmt::format("{} outside of {} x {} pixels.", counted(outside_, "event", "is", "are"),
                     summary.info.resolution_px.width_px, summary.info.resolution_px.height_px)});
  }
  if (const double step_s = stamp_step_.step_s(); step_s > 0.0)
    faults.push_back(
        {name, FaultKind::Encoding, 0.0,
         fmt::format("The time stamps step by {:.3g} ms: a time offset is uncertain by half of that.",
                     1e3 * step_s)});
  if (duration_s > 0.0) findHotPixels(duration_s, summary, faults);
}

// A quantile of the intervals that occur within edges: hot pixels and equal stamps are below it.
double EventStatistics::shortestInterval_s() const {
  constexpr std::uint64_t kMinIntervals = 10'000, kOneIn = 100;
  std::uint64_t all = 0, below = 0;
  for (const std::uint32_t count : intervals_) all += count;
  if (all < kMinIntervals) return 0.0;
  std::size_t interval = 0;
  while (kOneIn * (below += intervals_[interval]) < all) ++interval;
  return 1e-6 * kInterval_us * static_cast<double>(interval);
}

std::uint32_t EventStatistics::neighbourMedian(int x_px, int y_px) const {
  std::array<std::uint32_t, 8> counts{};
  std::size_t found = 0;
  for (int y = std::max(0, y_px - 1); y <= std::min(max_rows_ - 1, y_px + 1); ++y) {
    for (int x = std::max(0, x_px - 1); x <= std::min(counted_px_.width_px - 1, x_px + 1); ++x) {
      if (x == x_px && y == y_px) continue;
      const bool counted = y < counted_px_.height_px;
      counts[found++] = counted ? pixels_[static_cast<std::size_t>(y * counted_px_.width_px + x)].events : 0;
    }
  }
  if (found == 0) return 0;
  return medianOf(counts.begin(), counts.begin() + static_cast<std::ptrdiff_t>(found));
}

void EventStatistics::findHotPixels(double duration_s, StreamSummary& summary,
                                    std::vector<RecordingFault>& faults) const {
  const double mean =
      static_cast<double>(numbers_.count) / numbers_.seen_px.width_px / numbers_.seen_px.height_px;
  const double least = std::max({options_.hot_pixel_hz * duration_s, options_.hot_pixel_factor * mean,
                                 static_cast<double>(options_.hot_pixel_events)});
  std::vector<std::string> hot;
  double share = 0.0;
  const int columns = std::min(counted_px_.width_px, numbers_.seen_px.width_px);
  for (int y = 0; y < counted_px_.height_px; ++y) {
    for (int x = 0; x < columns; ++x) {
      const double count = pixels_[static_cast<std::size_t>(y * counted_px_.width_px + x)].events;
      if (count < least || count < options_.hot_pixel_factor * neighbourMedian(x, y)) continue;
      hot.push_back(fmt::format("({}, {})", x, y));
      share += count / static_cast<double>(numbers_.count);
    }
  }
  if (hot.empty()) return;
  const std::size_t total = hot.size();
  hot.resize(std::min(total, kMaxNamedPixels));
  std::string text = fmt::format("{} hot pixels give {:.1f} % of the events: {}{}.", total, 100.0 * share,
                                 joined(hot), total > hot.size() ? ", ..." : "");
  if (share < options_.hot_pixel_share)
    summary.note = std::move(text);
  else
    faults.push_back({summary.info.name, FaultKind::HotPixels, 0.0, std::move(text)});
}

}  // namespace evical
