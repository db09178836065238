// Who watches a calibration while it runs, for live views. Called from worker threads, one call at a time;
// what is handed over lives as long as the call: copy what is to be kept, and be quick.
#pragma once

#include <cstddef>
#include <string_view>

namespace evical {

struct BoardObservations;
struct CalibrationInput;
struct CalibrationState;
struct IntrinsicsResult;
struct IterationRecord;

// core/frontend/board_tracker.h; from here they are only handed on.
class BoardTracker;
class FrontEndObserver;

class CalibrationObserver {
 public:
  virtual ~CalibrationObserver() = default;

  // Asked for each camera before its first window: who is to see its windows stage by stage. Null: nobody.
  virtual FrontEndObserver* windowObserver(std::size_t /*camera*/, const BoardTracker& /*tracker*/) {
    return nullptr;
  }
  // New windows at the end of `so_far.windows`; earlier ones may change when the board is tracked backwards.
  virtual void windowsDetected(std::size_t /*camera*/, const BoardObservations& /*so_far*/) {}
  // The whole recording has been read.
  virtual void detectionDone(const CalibrationInput& /*input*/) {}
  // Of a camera's intrinsics alone: a pass over the recording, from 1, and the lens that it left.
  virtual void intrinsicsPassDone(int /*pass*/, const IntrinsicsResult& /*so_far*/) {}
  // "time offset", the sensor that it is of, its key number in words, and how long it took.
  virtual void initialisationStepDone(std::string_view /*step*/, std::string_view /*subject*/,
                                      std::string_view /*result*/, double /*duration_s*/) {}
  virtual void iterationDone(const IterationRecord& /*iteration*/, const CalibrationState& /*state*/) {}
};

}  // namespace evical
