#include "core/frames/blink.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical {
namespace {

constexpr double kBin_s = 1e-9 * static_cast<double>(kBlinkBin_ns);

// Selects pixels spread over the sensor.
bool isNth(const Event& event, std::uint32_t n) {
  return (event.x_px + 7u * event.y_px) % n == 0;
}

// Autocorrelation for lag 0 to the last, each divided by its number of products; 1 at lag 0.
std::vector<double> autocorrelation(std::span<const float> signal, std::size_t lags) {
  double mean = 0.0;
  for (const float value : signal) mean += value;
  mean /= static_cast<double>(signal.size());
  std::vector<double> centred;
  for (const float value : signal) centred.push_back(value - mean);
  std::vector<double> correlation;
  for (std::size_t lag = 0; lag < lags; ++lag) {
    double sum = 0.0;
    for (std::size_t k = 0; k + lag < centred.size(); ++k) sum += centred[k] * centred[k + lag];
    correlation.push_back(sum / static_cast<double>(centred.size() - lag));
  }
  const double power = correlation.front();
  for (double& value : correlation) value = power > 0.0 ? value / power : 0.0;
  return correlation;
}

// Position of a peak's maximum, in lags, from a parabola through the peak and its neighbours.
double summitOf(const std::vector<double>& correlation, std::size_t lag) {
  if (lag + 1 >= correlation.size()) return static_cast<double>(lag);
  const double before = correlation[lag - 1], at = correlation[lag], after = correlation[lag + 1];
  const double bend = before - 2.0 * at + after;
  return static_cast<double>(lag) + (bend < 0.0 ? 0.5 * (before - after) / bend : 0.0);
}

}  // namespace

std::optional<Blink> findBlink(std::span<const float> balance, const BlinkOptions& options) {
  // The peak must follow a valley, which a slow change of everything does not have; multiples of the period
  // have equal peaks.
  constexpr double kValley = 0.3, kNearlyHighest = 0.8;
  const auto longest = static_cast<std::size_t>(1.0 / (options.min_hz * kBin_s)) + 2;
  const std::size_t lags = std::min(longest, balance.size() / 2 + 1);
  const auto shortest = std::max<std::size_t>(2, static_cast<std::size_t>(1.0 / (options.max_hz * kBin_s)));
  if (lags <= shortest + 1) return std::nullopt;
  const std::vector<double> correlation = autocorrelation(balance, lags);
  std::vector<std::size_t> peaks;
  double highest = 0.0, lowest = 1.0;
  for (std::size_t lag = 1; lag + 1 < lags; ++lag) {
    lowest = std::min(lowest, correlation[lag]);
    const bool peak = correlation[lag] > correlation[lag - 1] && correlation[lag] >= correlation[lag + 1];
    if (!peak || lag < shortest || correlation[lag] < lowest + kValley) continue;
    peaks.push_back(lag);
    highest = std::max(highest, correlation[lag]);
  }
  for (const std::size_t lag : peaks)
    if (correlation[lag] >= kNearlyHighest * highest)
      return Blink{summitOf(correlation, lag) * kBin_s, correlation[lag]};
  return std::nullopt;
}

double shareOfBlinkingPixels(EventSpan events, Resolution resolution_px, double period_s) {
  constexpr double kNearlyEvery = 0.9;
  if (events.empty() || !(period_s > 0.0)) return 0.0;
  struct Pixel {
    int brightened = -1, darkened = -1, counted = -1;  // the last period of each
    int periods = 0;
    std::uint32_t events = 0;
  };
  std::vector<Pixel> pixels(static_cast<std::size_t>(resolution_px.pixelCount()));
  const std::int64_t start_ns = events.front().time_ns;
  const auto periodOf = [&](const Event& event) {
    return static_cast<int>(1e-9 * static_cast<double>(event.time_ns - start_ns) / period_s);
  };
  const int whole = periodOf(events.back());
  if (whole < 2) return 0.0;
  std::size_t all = 0;
  for (const Event& event : events) {
    const int period = periodOf(event);
    if (period >= whole) break;
    ++all;
    Pixel& pixel =
        pixels[static_cast<std::size_t>(event.y_px) * static_cast<std::size_t>(resolution_px.width_px) +
               event.x_px];
    ++pixel.events;
    (event.brighter ? pixel.brightened : pixel.darkened) = period;
    if (pixel.brightened != pixel.darkened || pixel.counted == period) continue;
    pixel.counted = period;
    ++pixel.periods;
  }
  std::size_t blinking = 0;
  for (const Pixel& pixel : pixels)
    if (pixel.periods >= kNearlyEvery * whole) blinking += pixel.events;
  return static_cast<double>(blinking) / static_cast<double>(all);
}

void BlinkNotice::restart(std::int64_t time_ns) {
  balance_.clear();
  kept_.clear();
  every_nth_ = 1;
  origin_ns_ = time_ns;
  judge_at_ = static_cast<std::size_t>(0.5 * options_.look_s / kBin_s);
}

std::size_t BlinkNotice::binOf(const Event& event) const {
  return static_cast<std::size_t>(std::max<std::int64_t>(0, event.time_ns - origin_ns_) / kBlinkBin_ns);
}

void BlinkNotice::add(EventSpan events) {
  for (const Event& event : events) {
    if (!blink_) weigh(event);
    keep(event);
  }
}

void BlinkNotice::keep(const Event& event) {
  if (!isNth(event, every_nth_)) return;
  kept_.push_back(event);
  if (blink_ || kept_.size() < max_kept_) return;
  every_nth_ *= 2;
  std::erase_if(kept_, [&](const Event& other) { return !isNth(other, every_nth_); });
}

void BlinkNotice::weigh(const Event& event) {
  const auto look = static_cast<std::size_t>(options_.look_s / kBin_s);
  if (balance_.empty() || binOf(event) > balance_.size() + look) restart(event.time_ns);
  if (binOf(event) >= judge_at_) judge();
  if (blink_) return;
  const std::size_t bin = binOf(event);
  if (bin >= balance_.size()) balance_.resize(bin + 1, 0.0f);
  balance_[bin] += event.brighter ? 1.0f : -1.0f;
}

// Twice per interval; older events are dropped.
void BlinkNotice::judge() {
  const auto look = static_cast<std::size_t>(options_.look_s / kBin_s);
  std::optional<Blink> found = findBlink(balance_, options_);
  if (found) {
    found->share = shareOfBlinkingPixels(kept_, resolution_px_, found->period_s);
    if (found->peak + found->share > clearest_.peak + clearest_.share) clearest_ = *found;
    if (found->peak >= options_.min_peak && found->share >= options_.min_share) blink_ = found;
  }
  if (blink_) return;
  if (balance_.size() > look) {
    const std::size_t old = balance_.size() - look / 2;
    balance_.erase(balance_.begin(), balance_.begin() + static_cast<std::ptrdiff_t>(old));
    origin_ns_ += static_cast<std::int64_t>(old) * kBlinkBin_ns;
    std::erase_if(kept_, [&](const Event& event) { return event.time_ns < origin_ns_; });
  }
  judge_at_ = balance_.size() + look / 2;
}

void BlinkNotice::finish() {
  if (!blink_ && !balance_.empty()) judge();
}

std::vector<Event> BlinkNotice::takeEvents() {
  if (std::exchange(every_nth_, 1) > 1) kept_.clear();
  return std::exchange(kept_, {});
}

}  // namespace evical
