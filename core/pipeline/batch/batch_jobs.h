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

}  // namespace evical
