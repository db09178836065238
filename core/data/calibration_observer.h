// Observer of a running calibration, for live views. Called from worker threads, one call at a time.
// Arguments are valid during the call only: copy them if necessary, and return quickly.
#pragma once

#include "core/data/calibration_result.h"

#include <array>
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

// The stages of a calibration, one row each: their names in progress, logs and result.yaml, and their share
// of a run's time. They are implemented in core/pipeline/rig/calibration_pipeline.cpp.
enum class CalibrationStage { FirstLook, Intrinsics, Detect, Initialise, Optimise, CompareHalves };

// Starting point of a run: determines its stages.
enum class RunStart { KnownIntrinsics, UnknownIntrinsics, Detections };

struct StageRow {
  CalibrationStage stage;
  const char* name;   // in ProgressSink::stageStarted, and in timing_s of result.yaml
  const char* title;  // for people
  // By RunStart: typical share of a run's time; 0 if such a run does not have the stage.
  std::array<double, 3> shares;
  double Timing::*duration_s;  // null: included in the total only
};

// In order of execution.
inline constexpr std::array<StageRow, 6> kCalibrationStages = {{
    {CalibrationStage::FirstLook, "first look", "First look", {0.0, 0.05, 0.0}, nullptr},
    {CalibrationStage::Intrinsics, "intrinsics", "Intrinsics", {0.0, 0.4, 0.0}, nullptr},
    {CalibrationStage::Detect, "detect", "Read and detect", {0.5, 0.25, 0.0}, &Timing::detect_s},
    {CalibrationStage::Initialise, "initialise", "Initialise", {0.05, 0.03, 0.1}, &Timing::initialise_s},
    {CalibrationStage::Optimise, "optimise", "Optimise", {0.35, 0.2, 0.7}, &Timing::optimise_s},
    {CalibrationStage::CompareHalves,
     "split_half_check",
     "Compare halves",
     {0.1, 0.07, 0.2},
     &Timing::split_half_check_s},
}};

constexpr const StageRow& rowOf(CalibrationStage stage) {
  return kCalibrationStages[static_cast<std::size_t>(stage)];
}

constexpr const char* nameOf(CalibrationStage stage) {
  return rowOf(stage).name;
}

constexpr double shareOf(const StageRow& row, RunStart start) {
  return row.shares[static_cast<std::size_t>(start)];
}

// visit(key, seconds) for each entry of timing_s; T is Timing or const Timing.
template <class T, class Visit>
void forEachTiming(T& timing, Visit&& visit) {
  visit("read", timing.read_s);
  for (const StageRow& row : kCalibrationStages)
    if (row.duration_s != nullptr) visit(row.name, timing.*row.duration_s);
  visit("total", timing.total_s);
}

}  // namespace evical
