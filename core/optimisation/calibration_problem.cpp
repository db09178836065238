#include "core/optimisation/calibration_problem.h"

#include "core/optimisation/measurement_residuals.h"
#include "core/optimisation/prior_residuals.h"
#include "core/optimisation/view_circles.h"

#include "core/geometry/so3.h"

#include <algorithm>
#include <cmath>

namespace evical {

bool So3Manifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  const Eigen::Map<const Eigen::Quaterniond> rotation(x);
  const Eigen::Vector3d step(delta[0], delta[1], delta[2]);
  Eigen::Map<Eigen::Quaterniond> moved(x_plus_delta);
  moved = (rotation * quaternionExp(step)).normalized();
  return true;
}

bool So3Manifold::PlusJacobian(const double*, double* jacobian) const {
  Eigen::Map<Eigen::Matrix<double, 4, 3, Eigen::RowMajor>> j(jacobian);
  j.setZero();
  j.topRows<3>().setIdentity();
  return true;
}

bool So3Manifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  const Eigen::Map<const Eigen::Quaterniond> to(y), from(x);
  Eigen::Map<Eigen::Vector3d> difference(y_minus_x);
  difference = quaternionLog(from.conjugate() * to);
  return true;
}

bool So3Manifold::MinusJacobian(const double*, double* jacobian) const {
  Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> j(jacobian);
  j.setZero();
  j.leftCols<3>().setIdentity();
  return true;
}

namespace {

ceres::Problem::Options borrowManifolds() {
  ceres::Problem::Options options;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  return options;
}

// Offsets of every sensor at the trajectory's begin and end; an accelerometer's includes its delay.
std::vector<double> timeOffsets_s(const CalibrationInput& input, const CalibrationState& state) {
  const So3Spline& trajectory = state.world_from_imu_rotation;
  std::vector<double> offsets_s;
  const auto append = [&](const auto& sensor) {
    for (const double time_s : {trajectory.start_s, trajectory.endTime_s()})
      offsets_s.push_back(timeOffsetAt_s(sensor, time_s));
  };
  for (std::size_t i = 0; i < state.cameras.size(); ++i) {
    append(state.cameras[i]);
    const double furthest_row =
        0.5 * input.cameras[i].lens.detection_intrinsics->resolution_px.height_px;  // from the middle row
    offsets_s.push_back(1e-6 * furthest_row * state.cameras[i].line_delay_us);
    constexpr double kFurthest_sigmas = 2.0;
    offsets_s.push_back(kFurthest_sigmas * exposureSpread_s(input.cameras[i].observations) *
                        state.cameras[i].exposure_share);
  }
  for (const ImuState& imu : state.imus) {
    append(imu);
    for (const double time_s : {trajectory.start_s, trajectory.endTime_s()})
      offsets_s.push_back(timeOffsetAt_s(imu, time_s) - imu.accelerometer_delay_s);
  }
  return offsets_s;
}

}  // namespace

CalibrationProblem::CalibrationProblem(const CalibrationInput& input, const OptimisationOptions& options,
                                       const CalibrationState& initial)
    : input_(input), options_(options), parameters_(input, options, initial) {
  // Amplitude errors hardly matter between cameras, since each one observes the board's pose independently.
  const double pixel_error_px = input.imus.empty() ? 0.0 : options.pixel_error_px;
  for (std::size_t i = 0; i < input.cameras.size(); ++i) {
    const CameraData& camera = input.cameras[i];
    const Board& board = input.boardAt(camera.board);
    circle_models_.push_back({*camera.lens.detection_intrinsics, board.radius_m, options.huber_sigma,
                              modesOf(input, i, options), options.freesIntrinsics()});
    pixel_errors_.emplace_back(camera, board, pixel_error_px);
  }
}

void CalibrationProblem::build(ParameterStages stage, const Weights& weights) {
  parameters_.followSensors();
  const CalibrationState& state = parameters_.moved();
  residuals_.clear();
  assigned_offsets_s_ = timeOffsets_s(input_, state);
  problem_ = std::make_unique<ceres::Problem>(borrowManifolds());
  ProblemBuilder builder{input_, options_, weights, stage, parameters_, *problem_, residuals_};
  for (std::size_t i = 0; i < state.cameras.size(); ++i)
    addCircles(builder, i, circle_models_[i], pixel_errors_[i]);
  for (std::size_t i = 0; i < state.imus.size(); ++i) {
    if (builder.isReference(i) || stage != ParameterStages::Extrinsics) addImu(builder, i);
  }
  addPriors(builder);
  addKnownValues(builder);
  if (input_.imus.empty()) addSmoothness(builder);
  setManifolds(builder);
  if (input_.imus.empty()) holdReferenceCamera(builder);
}

double CalibrationProblem::segmentDrift_knots() const {
  const CalibrationState& state = parameters_.moved();
  const std::vector<double> offsets_s = timeOffsets_s(input_, state);
  double largest_s = 0.0;
  for (std::size_t i = 0; i < offsets_s.size(); ++i)
    largest_s = std::max(largest_s, std::abs(offsets_s[i] - assigned_offsets_s_[i]));
  return largest_s /
         std::min(state.world_from_imu_rotation.knot_spacing_s, state.imu_in_world_m.knot_spacing_s);
}

void CalibrationProblem::setManifolds(ProblemBuilder& builder) {
  CalibrationState& state = parameters_.moved();
  const auto set = [&](double* block, ceres::Manifold* manifold) {
    if (builder.has(block)) problem_->SetManifold(block, manifold);
  };
  for (auto& point : state.world_from_imu_rotation.control_points) set(point.coeffs().data(), &so3_);
  for (CameraState& camera : state.cameras) set(camera.reference_from_camera.rotation.coeffs().data(), &so3_);
  for (std::size_t i = 0; i < input_.boardCount(); ++i)
    set(state.boardAt(i).world_from_board.rotation.coeffs().data(), &so3_);
  builder.hold(state.board.world_from_board.rotation.coeffs().data());
  builder.hold(state.board.world_from_board.translation_m.data());
  for (std::size_t i = 0; i < state.imus.size(); ++i) {
    double* gyroscope_rotation = state.imus[i].gyroscope_from_accelerometer.coeffs().data();
    set(state.imus[i].reference_from_imu.rotation.coeffs().data(), &so3_);
    set(gyroscope_rotation, &so3_);
    if (!builder.turnsGyroscope(i)) builder.hold(gyroscope_rotation);
    if (!builder.drifts(input_.imus[i].prior)) builder.hold(&state.imus[i].time_offset_drift_ppm);
  }
  for (std::size_t i = 0; i < state.cameras.size(); ++i) {
    if (!builder.drifts(input_.cameras[i].prior)) builder.hold(&state.cameras[i].time_offset_drift_ppm);
    if (!builder.rolls(i)) builder.hold(&state.cameras[i].line_delay_us);
    if (!builder.exposuresVary(i)) builder.hold(&state.cameras[i].exposure_share);
    if (input_.cameras[i].observations.kind == CameraKind::Events) continue;
    builder.hold(&state.cameras[i].edge_localisation_bias_px);  // only events have a lead
    builder.hold(&state.cameras[i].slow_edge_localisation_bias_px);
  }
  if (!options_.free_gravity_norm) set(state.gravity_in_world_m_s2.data(), &sphere_);
  for (std::size_t i = 0; i < state.cameras.size(); ++i)
    if (IntrinsicsBlock* block = parameters_.intrinsics(i); block && parameters_.ownsSensor(i))
      block->hold(*problem_, builder.stage == lastStage(options_));
  const bool last = builder.stage == lastStage(options_);
  for (const Quantity& quantity : parameters_.quantities()) {
    const QuantityRelease release = quantity.info->release;
    const bool held =
        (release == QuantityRelease::ImuIntrinsics && builder.stage != ParameterStages::Mappings) ||
        (release == QuantityRelease::BoardSize && !(last && options_.free_board_size)) ||
        (release == QuantityRelease::BoardBow && !(last && options_.board_bow)) ||
        (quantity.info->id == QuantityId::AccelerometerDelay && builder.delayIsHeld(quantity.sensor));
    if (held) builder.hold(quantity.block);
  }
}

// The trajectory is that of the reference camera.
void CalibrationProblem::holdReferenceCamera(ProblemBuilder& builder) {
  CameraState& reference = parameters_.moved().cameras[input_.reference_camera];
  builder.hold(reference.reference_from_camera.rotation.coeffs().data());
  builder.hold(reference.reference_from_camera.translation_m.data());
  builder.hold(&reference.time_offset_s);
  builder.hold(&reference.time_offset_drift_ppm);
}

std::vector<Quantity> CalibrationProblem::quantities() {
  std::vector<Quantity> all = parameters_.quantities();
  std::erase_if(all, [&](const Quantity& q) {
    return !problem_->HasParameterBlock(q.block) || problem_->IsParameterBlockConstant(q.block);
  });
  return all;
}

std::vector<Quantity> CalibrationProblem::driftBlocks() {
  std::vector<Quantity> all = parameters_.biasKnots();
  std::erase_if(all, [&](const Quantity& q) { return !problem_->HasParameterBlock(q.block); });
  return all;
}

std::vector<double*> CalibrationProblem::splineBlocks() {
  std::vector<double*> blocks = parameters_.controlPoints();
  std::erase_if(blocks, [&](const double* block) { return !problem_->HasParameterBlock(block); });
  return blocks;
}

}  // namespace evical
