// The batch's problem while it is put together: what measurements, priors and held values are added to.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/parameter_blocks.h"
#include "core/optimisation/weights.h"

#include <ceres/problem.h>

#include <vector>

namespace evical {

class CircleCost;

enum class SensorKind { Circles, Gyroscope, Accelerometer, Prior };

// What one residual block of the problem measures, and when.
struct BlockInfo {
  ceres::ResidualBlockId id = nullptr;
  SensorKind kind = SensorKind::Prior;
  std::size_t sensor = 0;  // index of the camera or IMU
  double time_s = 0.0;     // of its first measurement, on the reference IMU's clock
  const CircleCost* circles = nullptr;
};

// RMS over a camera's points; 0 where exposures are all the same, or not known.
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
  // Where nothing turns about some axis the gyroscope could take any turn about it.
  bool turnsGyroscope(std::size_t imu) const;
  // Where hardly anything accelerates along some axis, errors of the circles would pass for a board of another size.
  bool scaleIsHeld() const;
  // Where splines cannot follow the accelerations, the delay would be the one at which they miss least.
  bool delayIsHeld(std::size_t imu) const;
  // A clock with this prior. One whose offset is given is the reference's own, as far as anybody knows.
  bool drifts(const SensorPrior& prior) const;

  void addPrior(ceres::CostFunction* cost, const std::vector<double*>& blocks);
  bool rolls(std::size_t camera) const;          // its shutter, or as if it did for a test
  bool exposuresVary(std::size_t camera) const;  // so much that the exposure's share can be told
  void hold(double* block);                      // if it is in the problem
};

}  // namespace evical
