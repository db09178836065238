// A batch over a cluster by Slurm: an array job whose tasks each run one job of the batch. Slurm schedules; we write the
// script, submit it, and ask how far it is.
#pragma once

#include "core/pipeline/batch/batch_jobs.h"
#include "core/pipeline/batch/batch_outcome.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace evical {

struct SlurmRequest {
  std::filesystem::path program, folder;  // both absolute
  std::string options;                    // for sbatch, as a shell would split them
};

// Writes FOLDER/slurm.sh and submits it; jobs that are settled are left out. What sbatch said. Throws CalibrationError
// (CalibrationFailed) where it is not there or refuses, in its words; the script stays.
std::string submitToSlurm(const Batch& batch, const SlurmRequest& request);

// Of jobs that have not ended what the queue says of them, where the batch was submitted and squeue answers.
void addQueueStates(const Batch& batch, const std::filesystem::path& folder, std::span<JobOutcome> outcomes);

}  // namespace evical
