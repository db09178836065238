// A result with the run data of its folder.
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
  bool is_truth = false;             // of a simulation: without status, sigmas and residuals
  std::vector<std::string> missing;  // missing parts of an older or damaged folder, with the reason

  const CalibrationResult& numbers() const { return *named.result; }
  // A sigma or an RMS that the file does not have is 0 there: a truth, or a result without a covariance.
  double known(double number) const;
  std::string status() const;  // ok, doubtful, failed, or truth
  std::string yaml() const;    // content of result.yaml or truth.yaml
  bool hasTrajectory() const { return !numbers().state.world_from_imu_rotation.control_points.empty(); }
};

// The result of a run that has just ended; keeps its numbers, not its observations.
std::shared_ptr<const Result> resultOf(const Session& session, const CalibrationRun& run);

// From a result folder, its result.yaml, or a separate file like that. result.yaml is the truth: run.data is
// used only if it belongs to it. Throws CalibrationError (BadInput).
std::shared_ptr<const Result> loadResult(const std::filesystem::path& path);

// Pickled form of a result: result.yaml, and the numbers that it does not contain.
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

// Throws CalibrationError (BadInput) if the result has none.
Trajectory trajectoryOf(const std::shared_ptr<const Result>& result);

}  // namespace evical::python
