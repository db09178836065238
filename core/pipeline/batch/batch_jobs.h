// Batch: many recordings to be calibrated one by one, listed in a YAML file.
//
//   evical_batch: 1
//   session: car.yaml               # for jobs that name only a recording, which replaces the session's
//   set: {optimisation.knots.spacing_s: 0.02}     # for all jobs; a job's own settings are applied later
//   at_once: 4                      # jobs; default: number of processors divided by threads
//   threads: 1                      # per job
//   memory_limit_mb: 2000           # per job; default: none
//   jobs:
//     - monday/session.yaml         # a session,
//     - tuesday/recording.bag       # or a recording
//     - {name: third, session: other.yaml, recording: wednesday.bag, set: {...}}
//
// Paths are relative to the file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

struct BatchJob {
  std::string name;                   // the folder of its result
  std::filesystem::path session;      // absolute
  std::filesystem::path recording;    // replaces the session's; empty: the session's own
  std::vector<std::string> settings;  // "group.option=value"
};

struct Batch {
  std::filesystem::path file;  // absolute
  std::vector<BatchJob> jobs;
  int threads = 1, at_once = 1;
  int memory_limit_mb = 0;  // 0: none
};

// Sessions and recordings may be missing: their jobs report that. Throws CalibrationError (BadInput).
Batch readBatch(const std::filesystem::path& file);

// Outcome of a batch job, stored in FOLDER/jobs/NAME.yaml. It is written last: a job without this file must
// be run.
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
