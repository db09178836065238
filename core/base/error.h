// The exception of core for user-visible errors: what happened, where, and what to do.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>

namespace evical {

// The setting that fixes a problem, as data: a command line can print it and a window offer it.
struct Repair {
  // An option, "optimisation.model.gyroscope_rotation", a key of a session's IMU,
  // "imus.left_imu.acceleration_unit", or "time_range_s": accepted by setInSession
  // (core/pipeline/session/session.h).
  std::string key, value;

  bool operator==(const Repair&) const = default;
  std::string text() const { return key + "=" + value; }
};

enum class ErrorKind {
  BadInput,           // invalid usage, session or recording: exit code 2, no files written
  CalibrationFailed,  // a stage failed: exit code 1
};

class CalibrationError : public std::runtime_error {
 public:
  // `place` is a file, a key, a stream or a time; `advice` is an imperative. Neither ends with a full stop.
  CalibrationError(ErrorKind kind, std::string place, std::string problem, std::string advice = {});

  ErrorKind kind() const { return kind_; }
  const std::string& place() const { return place_; }
  const std::string& problem() const { return problem_; }
  const std::string& advice() const { return advice_; }
  // If the cause is certain: the settings that remove it.
  const std::optional<Repair>& repair() const { return repair_; }
  CalibrationError repairedBy(std::optional<Repair> repair) &&;

 private:
  ErrorKind kind_;
  std::string place_, problem_, advice_;
  std::optional<Repair> repair_;
};

CalibrationError badInput(std::string place, std::string problem, std::string advice = {});
CalibrationError calibrationFailed(std::string place, std::string problem, std::string advice = {});

// Thrown by RunContext::throwIfStopped. Not an error: the caller that started the run converts it to the
// outcome "cancelled".
struct Cancelled {};

}  // namespace evical
