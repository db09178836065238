// Where a run's time goes: its stages and what it logs, when which thread was at work, processors and memory in use, as a
// trace in the JSON that Chrome (chrome://tracing) and Perfetto open.
#pragma once

#include "core/base/progress.h"
#include "core/base/stopwatch.h"

#include <atomic>
#include <map>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace evical {

// Hands on to another sink what it is told. Threads and counters are looked at a hundred times a second, by a thread of its
// own that does not count; where the system does not tell of them (other systems than Linux) they are missing.
class RunTrace final : public ProgressSink {
 public:
  explicit RunTrace(ProgressSink& shown);

  void stageStarted(const ProgressStage& stage) override;
  void stageProgress(double fraction_of_stage) override { shown_.stageProgress(fraction_of_stage); }
  void log(LogLevel level, std::string_view text) override;

  // Until now; the last stage ends here.
  std::string json();

 private:
  struct Told {
    double at_s;
    std::string text;
  };
  // A stretch of time in which a thread was at work.
  struct Work {
    double begin_s, end_s, computing_s;
    std::size_t row;
  };
  struct Thread {
    double computing_s = 0.0;
    std::size_t row = 0;
    std::ptrdiff_t work = -1;  // the stretch that goes on, in work_
    bool seen = false;
  };
  struct Counters {
    double at_s, processors, memory_mb;
  };

  void watch(const std::stop_token& stop);
  void look();
  void lookAt(int thread_id, double computing_s, double now_s);
  std::size_t freeRow() const;

  ProgressSink& shown_;
  const Stopwatch stopwatch_;
  std::mutex mutex_;
  std::vector<Told> stages_, logged_;
  std::vector<Work> work_;
  std::vector<Counters> counters_;
  std::map<int, Thread> threads_;    // that are there, by the system's number
  double looked_s_ = 0.0, spent_s_;  // when it looked last, and what the process had computed by then
  std::atomic<int> watcher_id_ = 0;
  std::jthread watcher_;  // last: it uses the others
};

}  // namespace evical
