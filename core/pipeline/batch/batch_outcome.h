// How a job of a batch ended, as it stands in FOLDER/jobs/NAME.yaml: written last, so that a job with such a file has ended,
// and one without has to be run.
#pragma once

#include "core/pipeline/batch/batch_jobs.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

enum class JobEnd {
  NotRun,       // of a batch that was stopped before
  Elsewhere,    // another process is at it
  Done,         // there is a result, whatever its verdict
  Failed,       // there is none, and there would be none if it ran again
  BadInput,     // its session or recording is not as it should be
  OutOfMemory,  // more than the limit
  Killed,       // by somebody, or by its own fault
  Cancelled
};

const char* jobEndName(JobEnd end);

struct JobOutcome {
  JobEnd end = JobEnd::NotRun;
  std::string reason;  // empty of Done
  double wall_s = 0.0, peak_memory_mb = 0.0;
  std::vector<std::string> inputs;  // inputsOf
};

// What it was made of: its session and recording with sizes and times, and its settings.
std::vector<std::string> inputsOf(const BatchJob& job);

std::filesystem::path jobFile(const std::filesystem::path& folder, const BatchJob& job, const char* ending);

// Nothing where there is none that can be read.
std::optional<JobOutcome> readOutcome(const std::filesystem::path& folder, const BatchJob& job);
void writeOutcome(const std::filesystem::path& folder, const BatchJob& job, const JobOutcome& outcome);

// Whether it need not run again: it ended by itself, and nothing that it was made of has changed.
bool isSettled(const std::filesystem::path& folder, const BatchJob& job, const JobOutcome& outcome);

}  // namespace evical
