#include "core/recording/plausible_times.h"

#include "core/base/time.h"
#include "core/numerics/robust.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace evical {
namespace {

struct Rates {
  StreamType type;
  const char *items, *source;
  double min_hz, max_hz;              // that exist; of events: per pixel
  double usual_min_hz, usual_max_hz;  // that a corrected unit should give
  std::uint64_t fewest;               // items; fewer show no rate
  double shortest_s, longest_s;       // recordings
};
constexpr double kSmallestSensor = 128.0 * 128.0;  // pixels; events may reach only some
constexpr double kMinute_s = 60.0, kDay_s = 24.0 * 60.0 * kMinute_s;
// Calm scenes give few events per pixel, and a read-out limits their number. Cameras exist up to some kHz,
// and people take pictures by hand every minute. IMUs reach 32 kHz.
constexpr std::array<Rates, 4> kRates{{
    {StreamType::Events, "events", "event camera", 0.002, 1000.0, 0.02, 200.0, 1000, 0.005, 7.0 * kDay_s},
    {StreamType::Imu, "samples", "IMU", 0.5, 40'000.0, 20.0, 8000.0, 10, 0.0, 30.0 * kDay_s},
    {StreamType::Frames, "frames", "camera", 0.01, 10'000.0, 1.0, 200.0, 6, 0.0, 30.0 * kDay_s},
    {StreamType::Points, "views", "camera", 0.01, 10'000.0, 1.0, 200.0, 6, 0.0, 30.0 * kDay_s},
}};

struct Factor {
  double factor;
  const char *too_small, *too_large;  // units that were confused
};
constexpr std::array<Factor, 3> kFactors{{
    {1e3, "us read as ns, ms as us, or s as ms", "ns read as us, us as ms, or ms as s"},
    {1e6, "ms read as ns, or s as us", "ns read as ms, or us as s"},
    {1e9, "s read as ns", "ns read as s"},
}};

// The confusion of units that explains a rate; a rate that is too high comes from times that are too small.
std::string explanation(double rate_hz, bool too_high, const Rates& rates) {
  for (const Factor& each : kFactors) {
    const double true_hz = too_high ? rate_hz / each.factor : rate_hz * each.factor;
    if (true_hz < rates.usual_min_hz || true_hz > rates.usual_max_hz) continue;
    const bool of_pictures = rates.type == StreamType::Frames || rates.type == StreamType::Points;
    return fmt::format("The times seem to be {:g} times too {} ({}){}: correct their unit.", each.factor,
                       too_high ? "small" : "large", too_high ? each.too_small : each.too_large,
                       too_high && of_pictures ? ", or a count" : "");
  }
  return "They are not times, or their unit is wrong.";
}

// A rate per pixel, of which cameras other than event cameras have one.
struct Judged {
  double hz = 0.0, share = 1.0;
  bool too_high = false, too_low = false;
};

// Strays and gaps change the mean, bursts the median.
Judged judge(const SeenTimes& seen, const Rates& rates) {
  Judged out;
  if (rates.type == StreamType::Events) out.share = std::max(seen.pixels(), kSmallestSensor);
  const double mean_hz = 1.0 / seen.mean_s() / out.share;
  const double median_hz = seen.median_s() > 0.0 ? 1.0 / seen.median_s() / out.share : mean_hz;
  out.too_high = mean_hz > rates.max_hz;
  out.too_low = std::max(mean_hz, median_hz) < rates.min_hz;
  out.hz = out.too_low ? median_hz : mean_hz;
  return out;
}

std::string lengthText(double length_s) {
  return length_s < kMinute_s ? fmt::format("{:.3g} s", length_s)
                              : fmt::format("{:.3g} days", length_s / kDay_s);
}

}  // namespace

void SeenTimes::add(std::int64_t time_ns, std::uint64_t items) {
  constexpr std::size_t kMax = 4096;
  if (count_ > 0) {
    const double interval_s = std::max(0.0, secondsSince(last_ns_, time_ns));
    span_s_ += interval_s;
    if (intervals_s_.size() < kMax) intervals_s_.push_back(interval_s / static_cast<double>(items));
  }
  count_ += items;
  last_ns_ = time_ns;
}

// Events in few groups, since there are many; points of a view have the same time.
void SeenTimes::add(const Packet& packet) {
  constexpr std::size_t kGroups = 8;
  const std::size_t size = packet.events.size(), group = std::max<std::size_t>(1, size / kGroups);
  for (std::size_t done = 0; done < size;) {
    const std::size_t next = std::min(size, done + group);
    add(packet.events[next - 1].time_ns, next - done);
    reach(packet.events[next - 1]);
    done = next;
  }
  for (const RawImuSample& sample : packet.imu_samples) add(sample.time_ns);
  for (const Frame& frame : packet.frames) add(frame.time_ns);
  for (const MeasuredPoint& point : packet.points)
    if (count_ == 0 || point.time_ns != last_ns_) add(point.time_ns);
}

void SeenTimes::reach(const Event& event) {
  reached_px_.width_px = std::max<int>(reached_px_.width_px, event.x_px + 1);
  reached_px_.height_px = std::max<int>(reached_px_.height_px, event.y_px + 1);
}

double SeenTimes::mean_s() const {
  return count_ > 1 ? span_s_ / static_cast<double>(count_ - 1) : 0.0;
}

double SeenTimes::median_s() const {
  return intervals_s_.empty() ? 0.0 : medianOf(intervals_s_);
}

double SeenTimes::pixels() const {
  return static_cast<double>(reached_px_.width_px) * reached_px_.height_px;
}

std::optional<std::string> whyImplausible(StreamType type, const SeenTimes& seen) {
  const auto* const rates = std::ranges::find(kRates, type, &Rates::type);
  if (rates == kRates.end() || seen.count() < rates->fewest) return std::nullopt;
  if (seen.span_s() == 0.0) {
    if (type == StreamType::Imu) return std::nullopt;  // the check of IMUs states it
    return fmt::format(
        "All {} {} have the same time: it was rounded (by a spreadsheet, or as float32) or never set.",
        seen.count(), rates->items);
  }
  const Judged rate = judge(seen, *rates);
  if (rate.too_high || rate.too_low)
    return fmt::format("{:.6g} {} per s: no {} is this {}. {}", rate.hz * rate.share, rates->items,
                       rates->source, rate.too_high ? "fast" : "slow",
                       explanation(rate.hz, rate.too_high, *rates));
  const bool too_short = seen.span_s() < rates->shortest_s;
  const double usual_s = static_cast<double>(seen.count()) * seen.median_s();
  if (!too_short && usual_s <= rates->longest_s) return std::nullopt;
  return fmt::format("The {} {} take {}. {}", seen.count(), rates->items,
                     lengthText(too_short ? seen.span_s() : usual_s),
                     explanation(rate.hz, too_short, *rates));
}

bool areTimesOfPictures(std::vector<std::int64_t> times_ns) {
  if (times_ns.size() < 2) return true;
  std::ranges::sort(times_ns);
  SeenTimes seen;
  for (const std::int64_t time_ns : times_ns) seen.add(time_ns);
  if (seen.span_s() == 0.0) return false;
  const Judged judged = judge(seen, *std::ranges::find(kRates, StreamType::Frames, &Rates::type));
  return !judged.too_high && !judged.too_low;
}

}  // namespace evical
