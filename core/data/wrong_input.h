// Inputs that a recording contradicts: their names as causes, and units that explain an IMU's numbers.
#pragma once

#include "core/data/quality_warning.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace evical {

// Names of wrong inputs as causes, the ones that explain the others first.
inline constexpr const char* kWrongUnit = "unit";
inline constexpr const char* kWrongClock = "clock_rate";
inline constexpr const char* kWrongLens = "given_lens";
inline constexpr const char* kWrongBoard = "board_dimensions";
inline constexpr const char* kWrongNoise = "noise_density";

inline bool isWrongInput(const QualityWarning& reason) {
  constexpr std::array<std::string_view, 5> kNames = {kWrongUnit, kWrongClock, kWrongLens, kWrongBoard,
                                                      kWrongNoise};
  return std::ranges::find(kNames, std::string_view(reason.name)) != kNames.end();
}

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
