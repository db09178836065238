// The one exception that core throws at people: what went wrong, where, and what to do.
#pragma once

#include "core/base/repair.h"

#include <optional>
#include <stdexcept>
#include <string>

namespace evical {

enum class ErrorKind {
  BadInput,           // usage, session or recording: exit code 2, nothing written
  CalibrationFailed,  // a stage could not do its work: exit code 1
};

class CalibrationError : public std::runtime_error {
 public:
  // `place` names a file, a key, a stream or a time; `advice` tells what to do. Neither
  // ends with a full stop.
  CalibrationError(ErrorKind kind, std::string place, std::string problem, std::string advice = {});

  ErrorKind kind() const { return kind_; }
  const std::string& place() const { return place_; }
  const std::string& problem() const { return problem_; }
  const std::string& advice() const { return advice_; }
  // Of a cause that is certain, what can be set so that it is none any more.
  const std::optional<Repair>& repair() const { return repair_; }
  CalibrationError repairedBy(std::optional<Repair> repair) &&;

 private:
  ErrorKind kind_;
  std::string place_, problem_, advice_;
  std::optional<Repair> repair_;
};

CalibrationError badInput(std::string place, std::string problem, std::string advice = {});
CalibrationError calibrationFailed(std::string place, std::string problem, std::string advice = {});

// Thrown by RunContext::throwIfStopped. Not an error: whoever started the run turns
// it into the outcome "cancelled".
struct Cancelled {};

}  // namespace evical
