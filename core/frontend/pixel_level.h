// Level of a pixel between its darkest and its brightest; every event is a step of it. The level shows when
// an edge was in the middle of a pixel that it had not left, or does not leave, before it turned back
// (docs/maths.md, 4.1).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace evical {

// One burst of a pixel, as far as its level is concerned.
struct LevelBurst {
  bool brighter;
  int events;
  bool cut_begin;                    // events before it were considered noise
  bool rested_before, rested_after;  // the edge was out of the pixel's reach
};

class PixelLevel {
 public:
  struct Middle {
    double event;      // of the burst, counted from 0, perhaps between two: the edge is in the pixel's middle
    int whole_events;  // that an edge fires here from one side to the other, as far as is known
  };

  // Nothing if the edge was not in the middle during the burst. Bursts without knowledge of the time before
  // or after count as whole.
  std::optional<Middle> pass(const LevelBurst& burst);
  // Events that are too few for a burst.
  void step(bool brighter, int events);

 private:
  static constexpr float kUnknown = -1.0f;

  // Events of a whole burst that the edge had already fired at its present place.
  std::optional<double> had(const LevelBurst& burst) const;
  void set(bool brighter, double part) { level_ = static_cast<float>(brighter ? part : 1.0 - part); }

  std::array<std::uint16_t, 2> whole_ = {0, 0};  // events of the last whole burst, by polarity; 0: none yet
  float level_ = kUnknown;                       // 0 dark, 1 bright
};

}  // namespace evical
