// Runs the jobs of a batch as processes of their own, some at once; what has ended stays ended when it is run again.
#pragma once

#include "core/base/child_process.h"
#include "core/base/file_lock.h"
#include "core/pipeline/batch/batch_jobs.h"
#include "core/pipeline/batch/batch_outcome.h"

#include <filesystem>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace evical {

struct RunningJob {
  const BatchJob* job = nullptr;
  double elapsed_s = 0.0;
  std::string stage;  // what it said last
};

// Told by runBatch, in its thread.
class BatchWatcher {
 public:
  virtual ~BatchWatcher() = default;
  virtual void started(const BatchJob& job) = 0;
  virtual void ended(const BatchJob& job, const JobOutcome& outcome, bool earlier) = 0;
  virtual void running(std::span<const RunningJob> jobs) = 0;  // some times a second
};

struct BatchPlace {
  std::filesystem::path folder;   // for results; makeBatchFolder
  std::filesystem::path program;  // that calibrates: PROGRAM calibrate SESSION -o FOLDER
  bool wait_for_others = false;   // for jobs that another process is at, which are left alone otherwise
};

// Throws CalibrationError (BadInput) if it can't be made or written to.
void makeBatchFolder(const std::filesystem::path& folder);

// How each job ended, in their order. Where it is stopped, those that run are asked to end.
std::vector<JobOutcome> runBatch(const Batch& batch, const BatchPlace& place, BatchWatcher& watcher,
                                 std::stop_token stop);

// As they stand in the folder, without running any.
std::vector<JobOutcome> collectBatch(const Batch& batch, const std::filesystem::path& folder);

}  // namespace evical
