// Long work called from Python: runs without the interpreter's lock, reports progress, and stops on Ctrl-C.
#pragma once

#include "core/base/progress.h"
#include "core/base/time.h"

#include <pybind11/pybind11.h>

#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace evical::python {

// Collects a worker's messages for the caller's thread, since only that thread may call Python.
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
    bool moved = false;  // since the last takeNews()
    std::vector<Line> lines;
  };
  News takeNews();

 private:
  mutable std::mutex mutex_;
  News news_;
  std::string text_;
  Stopwatch since_start_;
};

// Calls `work` in a thread and waits for its end. Meanwhile it calls progress(stage, fraction) in the
// caller's thread and sends log lines to Python's logger "evical". If a signal handler or `progress` raises,
// work is asked to stop and is waited for, and that exception is thrown; else the one that work throws. Call
// with the interpreter's lock.
void runInterruptibly(const pybind11::object& progress, RunLog& log,
                      const std::function<void(const RunContext&)>& work);

// Raises TypeError unless `progress` is None or callable.
void checkProgress(const pybind11::object& progress);

}  // namespace evical::python
