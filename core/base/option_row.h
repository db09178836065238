// One option as text, for people, files and forms; and the error of two options that exclude each other.
#pragma once

#include "core/base/error.h"

#include <string>
#include <string_view>
#include <vector>

namespace evical {

// Public options are what people can judge, and are shown first; Expert ones are for those who know the method. Tuning
// is for tests and developers: in no form, help or document, without promises, and its names begin with "tuning.".
enum class Level { Tuning, Expert, Public };

inline constexpr std::string_view kTuning = "tuning.";

// The name in the tables: without "tuning.".
inline std::string_view nameInTables(std::string_view name) {
  return name.starts_with(kTuning) ? name.substr(kTuning.size()) : name;
}

// What an option needs to have an effect (idle_options.h).
enum class Applies {
  Always,
  WithImu,
  WithoutImu,
  WithEvents,
  WithFrames,
  WithRingVotes,
  WithNormalFlow,
  WithAprilGrid,
  WithCharuco,
  WithBlinkingBoard,
  WithUnknownLens,
  WithFreeGyroscopeTurns,
  WithFreeGravityNorm,
  WithLinearBiases,
  InCheck,
  InCheckWithoutBoard,
  InMaintain
};

// Minimum and maximum are empty for switches and choices, whose words `choices` gives.
struct OptionRow {
  std::string name, default_value, value, minimum, maximum, unit, help;
  std::vector<std::string> choices;
  Level level = Level::Tuning;
  std::vector<Applies> applies = {};  // all that it needs
};

// BadInput whose text names both options with their values.
class OptionConflict : public CalibrationError {
 public:
  OptionConflict(const OptionRow& lower, const OptionRow& upper);

  // Full names; the first must not be above the second.
  const std::string& lower() const { return lower_; }
  const std::string& upper() const { return upper_; }

 private:
  std::string lower_, upper_;
};

}  // namespace evical
