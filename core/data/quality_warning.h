// Reasons for a doubtful verdict.
#pragma once

#include "core/data/calibration_status.h"

#include "core/base/error.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace evical {

struct QualityWarning {
  std::string text;  // may be empty
  std::optional<Repair> repair = {};
  std::string name = "other";  // one word for programs: "lens", "board_size"
  double explains = 0.0;       // share of the misfit that is removed if this is estimated; 0: not tested
};

// Adds a reason to a verdict (a struct with status and reason). It becomes the first reason, since the user
// can fix it; so does its repair, if the verdict has a member for it.
template <class Verdict>
void flagDoubtful(const QualityWarning& doubt, Verdict& verdict) {
  if (doubt.text.empty()) return;
  verdict.status = CalibrationStatus::Doubtful;
  verdict.reason = verdict.reason.empty() ? doubt.text : doubt.text + "; " + verdict.reason;
  if constexpr (requires { verdict.repair; }) verdict.repair = doubt.repair;
  if constexpr (requires { verdict.causes; }) verdict.causes.insert(verdict.causes.begin(), doubt);
}
template <class Verdict>
void flagDoubtful(const std::string& doubt, Verdict& verdict, const char* name = "other") {
  flagDoubtful(QualityWarning{doubt, {}, name}, verdict);
}

// Inputs that a recording contradicts: their names as causes, and units that explain an IMU's numbers.

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

// Units that explain numbers which are `times` too large within `tolerance` (relative): "deg/s", or several
// joined by "or". Empty if there is none.
struct LikelyUnit {
  std::string words;
  std::string setting;  // of the first, as a session has it: "0.001 g"
  bool only = false;    // no other unit explains the numbers
};
// `read_as`: what the number 1 was taken for, in rad/s or m/s^2.
LikelyUnit likelyRateUnit(double read_as_rad_s, double times, double tolerance);
LikelyUnit likelyAccelerationUnit(double read_as_m_s2, double times, double tolerance);

}  // namespace evical
