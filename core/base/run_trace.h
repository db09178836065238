// Execution trace of a run: stages, logs, work per thread, processors and memory in use; in the JSON of
// Chrome (chrome://tracing) and Perfetto.
#pragma once

#include "core/base/progress.h"
#include "core/base/time.h"

#include <atomic>
#include <map>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace evical {

// Forwards all reports to another sink. Threads and counters are sampled 100 times per second by a separate
// thread, which is not counted; they are missing on other systems than Linux.
class RunTrace final : public ProgressSink {
 public:
  explicit RunTrace(ProgressSink& shown);

  void stageStarted(const ProgressStage& stage) override;
  void stageProgress(double fraction_of_stage) override { shown_.stageProgress(fraction_of_stage); }
  void log(LogLevel level, std::string_view text) override;

  // The trace until now; the last stage ends here.
  std::string json();

 private:
  struct Told {
    double at_s;
    std::string text;
  };
  // An interval in which a thread was working.
  struct Work {
    double begin_s, end_s, computing_s;
    std::size_t row;
  };
  struct Thread {
    double computing_s = 0.0;
    std::size_t row = 0;
    std::ptrdiff_t work = -1;  // index of the current interval in work_; -1: idle
    bool seen = false;
  };
  struct Counters {
    double at_s, processors, memory_mb;
  };

  void watch(const std::stop_token& stop);
  void sample();
  void lookAt(int thread_id, double computing_s, double now_s);
  std::size_t freeRow() const;

  ProgressSink& shown_;
  const Stopwatch stopwatch_;
  std::mutex mutex_;
  std::vector<Told> stages_, logged_;
  std::vector<Work> work_;
  std::vector<Counters> counters_;
  std::map<int, Thread> threads_;    // existing threads, by their id
  double looked_s_ = 0.0, spent_s_;  // latest sample: time, and computing time of the process
  std::atomic<int> watcher_id_ = 0;
  std::jthread watcher_;  // last member, so that it ends before the members that it uses are destroyed
};

}  // namespace evical
