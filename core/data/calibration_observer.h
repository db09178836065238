// Observer of a running calibration, for live views. Called from worker threads, one call at a time.
// Arguments are valid during the call only: copy them if necessary, and return quickly.
#pragma once

#include <cstddef>
#include <string_view>

namespace evical {

struct BoardObservations;
struct CalibrationInput;
struct CalibrationState;
struct IntrinsicsResult;
struct IterationRecord;

// core/frontend/board_tracker.h; only passed on here.
class BoardTracker;
class FrontEndObserver;

class CalibrationObserver {
 public:
  virtual ~CalibrationObserver() = default;

  // Called for each camera before its first window: returns the observer of the stages of its windows, or
  // null.
  virtual FrontEndObserver* windowObserver(std::size_t /*camera*/, const BoardTracker& /*tracker*/) {
    return nullptr;
  }
  // New windows at the end of `so_far.windows`; earlier ones may change when the board is tracked backwards.
  virtual void windowsDetected(std::size_t /*camera*/, const BoardObservations& /*so_far*/) {}
  // The complete recording has been read.
  virtual void detectionDone(const CalibrationInput& /*input*/) {}
  // Intrinsics calibration only: a pass over the recording, from 1, and the lens that results from it.
  virtual void intrinsicsPassDone(int /*pass*/, const IntrinsicsResult& /*so_far*/) {}
  // "time offset", its sensor, its main figure as text, and its duration.
  virtual void initialisationStepDone(std::string_view /*step*/, std::string_view /*subject*/,
                                      std::string_view /*result*/, double /*duration_s*/) {}
  virtual void iterationDone(const IterationRecord& /*iteration*/, const CalibrationState& /*state*/) {}
};

}  // namespace evical
