// Progress reports of long work, and the request to stop it. Without threads and GUI.
#pragma once

#include <stop_token>
#include <string>
#include <string_view>
#include <utility>

namespace evical {

class CalibrationObserver;  // core/data/calibration_observer.h; only passed on here

enum class LogLevel { Debug, Info, Warning };
const char* levelName(LogLevel level);  // as printed in logs

// A stage of long work. If several parts have stages of the same name, `part` identifies the part.
struct ProgressStage {
  // NOLINTBEGIN(google-explicit-constructor): most stages consist of a name
  ProgressStage(const char* given, std::string_view of = {}) : name(given), part(of) {}
  ProgressStage(std::string given, std::string_view of = {}) : name(std::move(given)), part(of) {}
  // NOLINTEND(google-explicit-constructor)

  bool operator==(const ProgressStage&) const = default;
  std::string text() const { return part.empty() ? name : part + ": " + name; }

  std::string name, part;  // of a calibration: core/data/calibration_observer.h
};

// Called from worker threads; implementations must lock if necessary. All fractions are work done / work to
// do.
class ProgressSink {
 public:
  virtual ~ProgressSink() = default;
  virtual void stageStarted(const ProgressStage& stage) = 0;
  virtual void stageProgress(double fraction_of_stage) = 0;  // 0..1
  virtual void log(LogLevel level, std::string_view text) = 0;
};

// Discards all reports; for tests and small tools.
ProgressSink& silentProgress();

struct RunContext {
  ProgressSink& progress = silentProgress();
  std::stop_token stop = {};
  CalibrationObserver* observer = nullptr;  // not owned; may be null

  void throwIfStopped() const;  // throws Cancelled
  // For sub-tasks whose stages are not those of the run.
  RunContext unobserved() const { return {progress, stop, nullptr}; }
};

}  // namespace evical
