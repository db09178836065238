#include "core/optimisation/problem_builder.h"

#include <cmath>

namespace evical {

double exposureSpread_s(const BoardObservations& observations) {
  double squares = 0.0;
  std::size_t points = 0;
  for (const BoardView& view : observations.views) {
    for (const CircleObservation& point : view.circles)
      squares += point.longer_exposed_s * point.longer_exposed_s;
    points += view.circles.size();
  }
  return points > 0 ? std::sqrt(squares / static_cast<double>(points)) : 0.0;
}

bool ProblemBuilder::turnsGyroscope(std::size_t imu) const {
  const std::optional<KnownRotation>& prior = input.imus[imu].prior.gyroscope_rotation;
  return (options.estimatesGyroscopeRotations() || prior) && !isGiven(prior) &&
         stage == ParameterStages::Mappings && weights.held_axes[imu].gyroscope.empty();
}

bool ProblemBuilder::delayIsHeld(std::size_t imu) const {
  return weights.scales.accelerometers[imu] > options.delay_misfit &&
         options.accelerometer_delay_sigma_s < options.unknown_delay_sigma_s;
}

bool ProblemBuilder::drifts(const SensorPrior& prior) const {
  const std::optional<KnownNumber>& drift = prior.time_offset_drift;
  if (drift) return options.free_time_offsets && !drift->isGiven();
  return options.free_time_offsets && options.time_offset_drift && !isGiven(prior.time_offset);
}

bool ProblemBuilder::rolls(std::size_t camera) const {
  const CameraData& data = input.cameras[camera];
  return data.observations.kind != CameraKind::Events && stage != ParameterStages::Extrinsics &&
         (data.shutter == Shutter::Rolling || options.estimatesLineDelays());
}

// With equal exposures of all frames, the exposure's share is part of the time offset.
bool ProblemBuilder::exposuresVary(std::size_t camera) const {
  constexpr double kMin_s = 1e-4;  // half of it is a measurable time
  return stage != ParameterStages::Extrinsics &&
         exposureSpread_s(input.cameras[camera].observations) > kMin_s;
}

void ProblemBuilder::addPrior(ceres::CostFunction* cost, const std::vector<double*>& blocks) {
  residuals.push_back({problem.AddResidualBlock(cost, nullptr, blocks)});
}

void ProblemBuilder::hold(double* block) {
  if (has(block)) problem.SetParameterBlockConstant(block);
}

}  // namespace evical
