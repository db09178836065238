// Detection of a blinking light in events (docs/maths.md, 7.5).
#pragma once

#include "core/data/event.h"
#include "core/frames/frame_options.h"
#include "core/geometry/resolution.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace evical {

struct Blink {
  double period_s = 0.0;
  double peak = 0.0;   // of the autocorrelation, 1 at most
  double share = 0.0;  // share of events from pixels that brighten and darken in every period
};

inline constexpr std::int64_t kBlinkBin_ns = 1'000'000;

// The first clear peak of the autocorrelation; `balance` is the number of ON minus OFF events in bins of
// kBlinkBin_ns. Empty if there is no peak, or if the data cover fewer than two periods.
std::optional<Blink> findBlink(std::span<const float> balance, const BlinkOptions& options);

// Blink::share of events in order of time, inside the resolution. 0 if they cover fewer than two periods.
double shareOfBlinkingPixels(EventSpan events, Resolution resolution_px, double period_s);

// Detects a blink in a stream of events. Keeps the events for further processing; if there are too many, only
// those of a subset of the pixels, which suffices to detect blinking.
class BlinkNotice {
 public:
  static constexpr std::size_t kMaxKept = 4'000'000;

  BlinkNotice(Resolution resolution_px, const BlinkOptions& options, std::size_t max_kept = kMaxKept)
      : resolution_px_(resolution_px), options_(options), max_kept_(max_kept) {}

  // Events in order of time, inside the resolution. Does nothing after a blink is detected.
  void add(EventSpan events);
  // End of the events: decides with the available ones.
  void finish();

  const std::optional<Blink>& blink() const { return blink_; }
  // The clearest blink so far, even if it was rejected.
  const Blink& clearest() const { return clearest_; }
  // Events from about one interval before the detection; empty if only a subset was kept.
  std::vector<Event> takeEvents();

 private:
  std::size_t binOf(const Event& event) const;
  void restart(std::int64_t time_ns);
  void weigh(const Event& event);
  void keep(const Event& event);
  void judge();

  Resolution resolution_px_;
  BlinkOptions options_;
  std::optional<Blink> blink_;
  Blink clearest_;
  std::vector<float> balance_;
  std::int64_t origin_ns_ = 0;
  std::size_t judge_at_ = 0;  // bins
  std::size_t max_kept_;
  std::uint32_t every_nth_ = 1;  // subset of pixels whose events are kept
  std::vector<Event> kept_;
};

}  // namespace evical
