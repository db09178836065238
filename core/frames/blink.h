// A light that goes on and off, as an event camera sees it (docs/maths.md, 7.5).
#pragma once

#include "core/data/event.h"
#include "core/frames/blink_options.h"
#include "core/geometry/resolution.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace evical {

struct Blink {
  double period_s = 0.0;
  double peak = 0.0;   // of the autocorrelation, 1 at most
  double share = 0.0;  // of events in pixels that brighten and darken in every period
};

inline constexpr std::int64_t kBlinkBin_ns = 1'000'000;

// The first clear peak of the autocorrelation; `balance` is brightening less darkening events in bins of
// kBlinkBin_ns. Nothing where there is none, or where fewer than two periods are seen.
std::optional<Blink> findBlink(std::span<const float> balance, const BlinkOptions& options);

// Of events in order of time, inside the resolution. 0 where they do not reach over two periods.
double shareOfBlinkingPixels(EventSpan events, Resolution resolution_px, double period_s);

// Looks for a blink in events as they come. It keeps them for who wants to go on from them; where they are too many, those
// of a part of the pixels, which tell as well whether pixels blink.
class BlinkNotice {
 public:
  static constexpr std::size_t kMostKept = 4'000'000;

  BlinkNotice(Resolution resolution_px, const BlinkOptions& options, std::size_t most_kept = kMostKept)
      : resolution_px_(resolution_px), options_(options), most_kept_(most_kept) {}

  // Events in order of time, inside the resolution. Does nothing once a blink is noticed.
  void add(EventSpan events);
  // No more will come: judges by what there is.
  void finish();

  const std::optional<Blink>& blink() const { return blink_; }
  // The clearest that was seen, whether it was enough or not.
  const Blink& clearest() const { return clearest_; }
  // Since about a look before the blink was noticed; none where only a part of them was kept.
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
  std::size_t most_kept_;
  std::uint32_t every_nth_ = 1;  // pixel, of which events are kept
  std::vector<Event> kept_;
};

}  // namespace evical
