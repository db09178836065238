// The scenario according to its session: the truth, except for the session's errors.
#pragma once

#include "core/synthetic/scenario.h"

namespace evical {

Scenario asSessionSays(Scenario scenario);

// True place of a circle's centre on the board.
inline Eigen::Vector2d trueCentre_m(const Scenario& scenario, int circle) {
  const Eigen::Vector2d centre_m = scenario.board.point_m(circle);
  return {centre_m.x(), (1.0 + scenario.board_stretch) * centre_m.y()};
}

}  // namespace evical
