// Guesses of a wrong unit from the ratio of an IMU's numbers to the right ones.
#pragma once

#include "core/data/imu_units.h"

#include <optional>
#include <string>

namespace evical {

// Units that explain numbers which are `times` too large: "deg/s", or several joined by "or". A session's name for it,
// if it has one. Empty if no unit explains them within `tolerance` (relative).
struct LikelyUnit {
  std::string words;
  std::optional<std::string> in_session;
};
LikelyUnit likelyUnit(AngularRateUnit read_as, double times, double tolerance);
LikelyUnit likelyUnit(AccelerationUnit read_as, double times, double tolerance);

}  // namespace evical
