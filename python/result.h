// A result with all that its folder keeps of the run.
#pragma once

#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/report/result_yaml.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace evical::python {

struct Result {
  NamedResult named;
  std::vector<std::string> missing;  // what an older or damaged folder lacks, and why

  const CalibrationResult& numbers() const { return *named.result; }
  bool hasTrajectory() const { return !numbers().state.world_from_imu_rotation.control_points.empty(); }
};

// Of a run that has just ended; keeps its numbers, not its observations.
std::shared_ptr<const Result> resultOf(const Session& session, const CalibrationRun& run);

// A result folder, its result.yaml, or such a file by itself. Throws CalibrationError (BadInput).
std::shared_ptr<const Result> loadResult(const std::filesystem::path& path);

// Pickled form of a result: result.yaml, and the numbers that it does not hold.
struct ResultState {
  std::string yaml, data;
  std::vector<std::string> missing;
};
ResultState stateOf(const Result& result);
std::shared_ptr<Result> resultFrom(const ResultState& state);

// The reference's motion: seconds since the recording's start on the reference's clock.
struct Trajectory {
  std::shared_ptr<const Result> result;
};

// Throws CalibrationError (BadInput) where the result has none.
Trajectory trajectoryOf(const std::shared_ptr<const Result>& result);

}  // namespace evical::python
