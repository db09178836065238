// One option as text, for users, files and forms; and the error of two options that contradict each other.
#pragma once

#include "core/base/error.h"

#include <string>
#include <string_view>
#include <vector>

namespace evical {

// Public options need no knowledge of the method, and are shown first; Expert options need it. Tuning options
// are for tests and developers: absent from forms, help and documents, without guarantees; their names begin
// with "tuning.".
enum class Level { Tuning, Expert, Public };

inline constexpr std::string_view kTuning = "tuning.";

// Name in the tables: without "tuning.".
inline std::string_view nameInTables(std::string_view name) {
  return name.starts_with(kTuning) ? name.substr(kTuning.size()) : name;
}

// The conditions under which an option has an effect (idle_options.h).
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

// Minimum and maximum are empty for switches and choices; `choices` lists the words of a choice.
struct OptionRow {
  std::string name, default_value, value, minimum, maximum, unit, help;
  std::vector<std::string> choices;
  Level level = Level::Tuning;
  std::vector<Applies> applies = {};  // all must be met
};

// BadInput whose text gives both options with their values.
class OptionConflict : public CalibrationError {
 public:
  OptionConflict(const OptionRow& lower, const OptionRow& upper);

  // Full names; the first must not exceed the second.
  const std::string& lower() const { return lower_; }
  const std::string& upper() const { return upper_; }

 private:
  std::string lower_, upper_;
};

// Declarations for the header of an options struct. Its rows (defaults, ranges, help) are in its source file
// (option_field.h, option_table.h), so that a change of a default or a text rebuilds only that source.
//
//   struct NormalFlowOptions {
//     int plane_radius_px;
//     double max_error_s;
//
//     NormalFlowOptions();  // the defaults
//     constexpr explicit NormalFlowOptions(NoDefaults) {}
//     bool operator==(const NormalFlowOptions&) const = default;
//     static const OptionTable<NormalFlowOptions>& table();
//   };

// Tag of the constructor that leaves members uninitialised: defaultsOf (option_field.h) sets them.
struct NoDefaults {};

template <class Options>
class OptionTable;

}  // namespace evical
