// What a batch tells while it runs: a line for each job at work, rewritten on a terminal; otherwise a line when one begins
// and one when it ends.
#pragma once

#include "core/base/stopwatch.h"
#include "core/pipeline/batch/batch_run.h"

#include <cstddef>

namespace evical {

class BatchLines final : public BatchWatcher {
 public:
  BatchLines(std::size_t jobs, bool quiet);
  ~BatchLines() override;

  void started(const BatchJob& job) override;
  void ended(const BatchJob& job, const JobOutcome& outcome, bool earlier) override;
  void running(std::span<const RunningJob> jobs) override;

 private:
  void clearLines();
  std::string summary() const;

  std::size_t jobs_, ended_ = 0, ended_here_ = 0;
  bool quiet_, on_terminal_;
  std::size_t shown_ = 0;  // lines that stand below
  Stopwatch of_all_, since_shown_;
};

}  // namespace evical
