// What long work may tell the outside, and how it learns that it should stop. No threads, no GUI in here.
#pragma once

#include <stop_token>
#include <string>
#include <string_view>
#include <utility>

namespace evical {

class CalibrationObserver;  // core/data/calibration_observer.h; from here it is only handed on

enum class LogLevel { Debug, Info, Warning };
const char* levelName(LogLevel level);  // as logs have it

// A stage of long work. Stages of several parts have the same names: then `part` tells which one it is of.
struct ProgressStage {
  // NOLINTBEGIN(google-explicit-constructor): most stages are a name
  ProgressStage(const char* given, std::string_view of = {}) : name(given), part(of) {}
  ProgressStage(std::string given, std::string_view of = {}) : name(std::move(given)), part(of) {}
  // NOLINTEND(google-explicit-constructor)

  bool operator==(const ProgressStage&) const = default;
  std::string text() const { return part.empty() ? name : part + ": " + name; }

  std::string name, part;  // of a calibration: core/data/calibration_stage.h
};

// Called from worker threads; implementations lock where they must. All fractions are real: work
// done / work to do.
class ProgressSink {
 public:
  virtual ~ProgressSink() = default;
  virtual void stageStarted(const ProgressStage& stage) = 0;
  virtual void stageProgress(double fraction_of_stage) = 0;  // 0..1
  virtual void log(LogLevel level, std::string_view text) = 0;
};

// Swallows everything; for tests and small tools.
ProgressSink& silentProgress();

struct RunContext {
  ProgressSink& progress = silentProgress();
  std::stop_token stop = {};
  CalibrationObserver* observer = nullptr;  // not owned; null: nobody watches

  void throwIfStopped() const;  // throws Cancelled
  // For work on the way whose steps are not those of the run itself.
  RunContext unobserved() const { return {progress, stop, nullptr}; }
};

}  // namespace evical
