// Runs the jobs of a batch as separate processes, several in parallel. Finished jobs are not run again.
#pragma once

#include "core/base/child_process.h"
#include "core/base/file_places.h"
#include "core/pipeline/batch/batch_jobs.h"

#include <filesystem>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace evical {

struct RunningJob {
  const BatchJob* job = nullptr;
  double elapsed_s = 0.0;
  std::string stage;  // last reported stage
};

// Called by runBatch in its thread.
class BatchWatcher {
 public:
  virtual ~BatchWatcher() = default;
  virtual void started(const BatchJob& job) = 0;
  virtual void ended(const BatchJob& job, const JobOutcome& outcome, bool earlier) = 0;
  virtual void running(std::span<const RunningJob> jobs) = 0;  // several times per second
};

struct BatchPlace {
  std::filesystem::path folder;   // of results; see makeBatchFolder
  std::filesystem::path program;  // called as: PROGRAM calibrate SESSION -o FOLDER
  bool wait_for_others = false;   // for jobs run by another process, which are skipped otherwise
};

// Throws CalibrationError (BadInput) if it can't be made or written to.
void makeBatchFolder(const std::filesystem::path& folder);

// Outcome of each job, in their order. When stopped, it asks running jobs to end.
std::vector<JobOutcome> runBatch(const Batch& batch, const BatchPlace& place, BatchWatcher& watcher,
                                 std::stop_token stop);

// Outcomes stored in the folder, without running jobs.
std::vector<JobOutcome> collectBatch(const Batch& batch, const std::filesystem::path& folder);

}  // namespace evical
