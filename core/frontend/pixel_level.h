// Level of a pixel between its darkest and its brightest; every event is a step of it. The level determines
// when an edge that turned back before leaving the pixel, or had not left it before, was in the pixel's
// middle (docs/maths.md, 4.1).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace evical {

// Data of a pixel's burst for its level.
struct LevelBurst {
  bool brighter;
  int events;
  bool cut_begin;                    // events before it were considered noise
  bool rested_before, rested_after;  // the edge was out of the pixel's reach
};

class PixelLevel {
 public:
  struct Middle {
    double event;      // with the edge in the pixel's middle: from 0, fractional between two events
    int whole_events;  // estimated number of events of an edge that crosses the pixel completely
  };

  // Empty if the edge was not in the middle during the burst. Bursts with unknown time before or after are
  // treated as complete.
  std::optional<Middle> pass(const LevelBurst& burst);
  // Update by events that are too few for a burst.
  void step(bool brighter, int events);

 private:
  static constexpr float kUnknown = -1.0f;

  // Number of a complete burst's events that the edge had already fired at its present place.
  std::optional<double> had(const LevelBurst& burst) const;
  void set(bool brighter, double part) { level_ = static_cast<float>(brighter ? part : 1.0 - part); }

  std::array<std::uint16_t, 2> whole_ = {0,
                                         0};  // events of the last complete burst, by polarity; 0: none yet
  float level_ = kUnknown;                    // 0 dark, 1 bright
};

}  // namespace evical
