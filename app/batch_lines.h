// Progress of a batch: one line per running job, rewritten on a terminal; otherwise a line at the start and
// the end of each job.
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
  std::size_t shown_ = 0;  // number of lines currently shown
  Stopwatch of_all_, since_shown_;
};

}  // namespace evical
