// A batch: many recordings to be calibrated one by one, listed in a YAML file.
//
//   evical_batch: 1
//   session: car.yaml               # of jobs that name a recording only, in the place of its own recording
//   set: {optimisation.knots.spacing_s: 0.02}     # of all jobs; a job's own come after it
//   at_once: 4                      # jobs; default: as many as there are processors for their threads
//   threads: 1                      # of each job
//   memory_limit_mb: 2000           # of each job; default: none
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
  std::filesystem::path recording;    // in the place of the session's; empty: the session's own
  std::vector<std::string> settings;  // "group.option=value"
};

struct Batch {
  std::filesystem::path file;  // absolute
  std::vector<BatchJob> jobs;
  int threads = 1, at_once = 1;
  int memory_limit_mb = 0;  // 0: none
};

// Sessions and recordings need not be there: that is their jobs' concern. Throws CalibrationError (BadInput).
Batch readBatch(const std::filesystem::path& file);

}  // namespace evical
