// Long work for a caller in Python: without the interpreter's lock, with progress, and stopped by Ctrl-C.
#pragma once

#include "core/base/progress.h"
#include "core/base/stopwatch.h"

#include <pybind11/pybind11.h>

#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace evical::python {

// Keeps what a worker tells until the caller's thread asks, since only that one may call Python.
class RunLog final : public ProgressSink {
 public:
  void stageStarted(const ProgressStage& stage) override;
  void stageProgress(double fraction_of_stage) override;
  void log(LogLevel level, std::string_view text) override;

  std::string text() const;  // of log.txt

  struct Line {
    LogLevel level;
    std::string text;
  };
  struct News {
    std::string stage;
    double fraction = 0.0;
    bool moved = false;  // since it was asked for last
    std::vector<Line> lines;
  };
  News takeNews();

 private:
  mutable std::mutex mutex_;
  News news_;
  std::string text_;
  Stopwatch since_start_;
};

// Calls `work` in a thread and waits for its end, meanwhile handing on news: progress(stage, fraction) in the caller's
// thread, log lines to Python's logger "evical". Where a signal's handler or `progress` raises, work is asked to stop
// and waited for, and that is thrown; else what work throws. Call with the interpreter's lock.
void runInterruptibly(const pybind11::object& progress, RunLog& log,
                      const std::function<void(const RunContext&)>& work);

// None, or what can be called; else raises TypeError.
void checkProgress(const pybind11::object& progress);

}  // namespace evical::python
