// What long work may tell the outside, and how it learns that it should stop. No threads, no GUI in here.
#pragma once

#include <stop_token>
#include <string>
#include <string_view>

namespace evical {

enum class LogLevel { Debug, Info, Warning };

// Called from worker threads; implementations lock where they must. All fractions are real: work done / work
// to do.
class ProgressSink {
 public:
  virtual ~ProgressSink() = default;
  virtual void stageStarted(std::string_view stage) = 0;     // "detect", "initialise", ...
  virtual void stageProgress(double fraction_of_stage) = 0;  // 0..1
  virtual void log(LogLevel level, std::string_view text) = 0;
};

// Swallows everything; for tests and small tools.
ProgressSink& silentProgress();

struct RunContext {
  ProgressSink& progress = silentProgress();
  std::stop_token stop = {};

  void throwIfStopped() const;  // throws Cancelled
};

}  // namespace evical
