// The batch's problem during construction, to which measurements, priors and fixed values are added.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/parameter_blocks.h"
#include "core/optimisation/weights.h"

#include <ceres/problem.h>

#include <vector>

namespace evical {

class ViewCost;

enum class SensorKind { Circles, Gyroscope, Accelerometer, Prior };

// Measurement and time of one residual block of the problem.
struct BlockInfo {
  ceres::ResidualBlockId id = nullptr;
  SensorKind kind = SensorKind::Prior;
  std::size_t sensor = 0;  // index of the camera or IMU
  double time_s = 0.0;     // of its first measurement, on the reference IMU's clock
  const ViewCost* view = nullptr;
};

// RMS over a camera's points; 0 if exposures are equal or unknown.
double exposureSpread_s(const BoardObservations& observations);

struct ProblemBuilder {
  const CalibrationInput& input;
  const OptimisationOptions& options;
  const Weights& weights;
  ParameterStages stage;
  ParameterBlocks& parameters;
  ceres::Problem& problem;
  std::vector<BlockInfo>& residuals;

  bool has(const double* block) const { return problem.HasParameterBlock(block); }
  bool isReference(std::size_t imu) const { return imu == input.reference_imu; }
  // Without rotation about some axis, the gyroscope's rotation about it is undetermined.
  bool turnsGyroscope(std::size_t imu) const;
  // If splines cannot follow the accelerations, the delay would take the value with the smallest misfit.
  bool delayIsHeld(std::size_t imu) const;
  // A clock with this prior. A given offset belongs to a clock that is presumably the reference's own.
  bool drifts(const SensorPrior& prior) const;

  void addPrior(ceres::CostFunction* cost, const std::vector<double*>& blocks);
  bool rolls(std::size_t camera) const;          // rolling shutter, or one assumed for a test
  bool exposuresVary(std::size_t camera) const;  // so much that they determine the exposure's share
  void hold(double* block);                      // fixes it if it is in the problem
};

}  // namespace evical
