// Delay of pixels for edges that brighten them, minus that for edges that darken them: a sign of low light,
// or of slow biases. Bursts are behind their edge by the pixel's delay times the edge's speed. Of a circle's
// leading and trailing edges one brightens and one darkens, so circles seem to grow or to shrink in
// proportion to their speed:
//   radius offset = r0 + s (d_brightening - d_darkening) / 2 * speed,  s = 1 for dark circles, -1 for bright ones.
// docs/maths.md, 10.1.
#pragma once

#include "core/data/board_observations.h"
#include "core/geometry/board.h"

#include <optional>

namespace evical {

class PolarityDelayFit {
 public:
  // Adds one window: the speed of the board's image, and the distance of bursts outside the circles' edges,
  // both in the sensor's pixels. Edges that hardly move are ignored.
  void add(double speed_px_s, double radius_offset_px);

  // Empty for few windows, or for one speed. The sigma assumes independent errors of windows.
  std::optional<PolarityDelay> result(CircleShade shade) const;

 private:
  double count_ = 0.0, speed_ = 0.0, offset_ = 0.0;  // sums
  double speed2_ = 0.0, offset2_ = 0.0, product_ = 0.0;
};

}  // namespace evical
