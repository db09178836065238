// Outcome of a batch job, stored in FOLDER/jobs/NAME.yaml. It is written last: a job without this file must
// be run.
#pragma once

#include "core/pipeline/batch/batch_jobs.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

enum class JobEnd {
  NotRun,       // the batch was stopped before
  Elsewhere,    // another process runs it
  Done,         // it has a result, with any verdict
  Failed,       // it has no result, and would not have one if it ran again
  BadInput,     // its session or recording is invalid
  OutOfMemory,  // exceeded the limit
  Killed,       // by a signal from outside, or by a crash
  Cancelled
};

const char* jobEndName(JobEnd end);

struct JobOutcome {
  JobEnd end = JobEnd::NotRun;
  std::string reason;  // empty if Done
  double wall_s = 0.0, peak_memory_mb = 0.0;
  std::vector<std::string> inputs;  // inputsOf
};

// Inputs of a job: session and recording with sizes and times, and settings.
std::vector<std::string> inputsOf(const BatchJob& job);

std::filesystem::path jobFile(const std::filesystem::path& folder, const BatchJob& job, const char* ending);

// Absent if there is no readable outcome.
std::optional<JobOutcome> readOutcome(const std::filesystem::path& folder, const BatchJob& job);
void writeOutcome(const std::filesystem::path& folder, const BatchJob& job, const JobOutcome& outcome);

// True if the job need not run again: it ended without a signal, and its inputs are unchanged.
bool isSettled(const std::filesystem::path& folder, const BatchJob& job, const JobOutcome& outcome);

}  // namespace evical
