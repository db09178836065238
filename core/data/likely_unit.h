// Guesses of a wrong unit from the ratio of an IMU's numbers to the right ones.
#pragma once

#include <string>

namespace evical {

// Units that explain numbers which are `times` too large within `tolerance` (relative): "deg/s", or several joined by "or".
// Empty if there is none.
struct LikelyUnit {
  std::string words;
  std::string setting;  // of the first, as a session has it: "0.001 g"
  bool only = false;    // no other unit explains the numbers
};
// `read_as`: what the number 1 was taken for, in rad/s or m/s^2.
LikelyUnit likelyRateUnit(double read_as_rad_s, double times, double tolerance);
LikelyUnit likelyAccelerationUnit(double read_as_m_s2, double times, double tolerance);

}  // namespace evical
