// A batch on a cluster with Slurm: an array job with one task per job of the batch. Writes the script,
// submits it, and queries its state.
#pragma once

#include "core/pipeline/batch/batch_jobs.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace evical {

struct SlurmRequest {
  std::filesystem::path program, folder;  // both absolute
  std::string options;                    // for sbatch, separated by blanks
};

// Writes FOLDER/slurm.sh and submits it, without the settled jobs. Returns the message of sbatch. Throws
// CalibrationError (CalibrationFailed) with its message if it is missing or refuses; the script remains.
std::string submitToSlurm(const Batch& batch, const SlurmRequest& request);

// Adds the queue's state to unfinished jobs, if the batch was submitted and squeue answers.
void addQueueStates(const Batch& batch, const std::filesystem::path& folder, std::span<JobOutcome> outcomes);

}  // namespace evical
