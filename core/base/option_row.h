// One option as text, for people, files and forms; and the error of two options that exclude each other.
#pragma once

#include "core/base/error.h"

#include <string>
#include <vector>

namespace evical {

// Minimum and maximum are empty for switches and choices, whose words `choices` gives.
struct OptionRow {
  std::string name, default_value, value, minimum, maximum, unit, help;
  std::vector<std::string> choices;
  bool expert = false;  // not among what people usually turn
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
