// What weighs on the unknowns besides measurements, and what is held.
#include "core/numerics/angles.h"
#include "core/optimisation/calibration_problem.h"
#include "core/optimisation/free_intrinsics.h"
#include "core/optimisation/prior_cost.h"
#include "core/optimisation/smoothness_cost.h"

#include <array>

namespace evical {
namespace {

constexpr std::array<double, 6> kZero = {};
constexpr std::array<double, 6> kIdentity = {1.0, 0.0, 0.0, 1.0, 0.0, 1.0};

}  // namespace

void CalibrationProblem::addPrior(double* block, int size, const double* mean, double sigma) {
  if (!problem_->HasParameterBlock(block)) return;
  blocks_.push_back({problem_->AddResidualBlock(new PriorCost(mean, size, sigma), nullptr, block)});
}

void CalibrationProblem::addPriors(ReleaseStages stage) {
  for (CameraState& camera : state_.cameras) {
    addPrior(&camera.edge_lead_px, 1, kZero.data(), options_.edge_lead_sigma_px);
    addPrior(&camera.edge_lead_growth_px, 1, kZero.data(), options_.edge_lead_growth_sigma_px);
  }
  for (const auto& block : intrinsics_)
    if (block && problem_->HasParameterBlock(block->data())) blocks_.push_back({block->addPrior(*problem_)});
  for (std::size_t i = 0; i < state_.cameras.size(); ++i) {
    const std::optional<KnownVector>& known = input_.cameras[i].prior.translation;
    double* translation = state_.cameras[i].reference_from_camera.translation_m.data();
    if (!known) addPrior(translation, 3, kZero.data(), options_.translation_sigma_m);
    holdTranslation(translation, known);
  }
  for (std::size_t i = 0; i < state_.imus.size(); ++i) {
    addImuPriors(i);
    if (stage == ReleaseStages::Mappings) addMappingPriors(i, stage);
  }
  double* gravity = state_.gravity_in_world_m_s2.data();
  if (!options_.free_gravity_norm || !problem_->HasParameterBlock(gravity)) return;
  auto* cost = new NormCost(input_.gravity_norm_m_s2, options_.gravity_norm_sigma_m_s2);
  blocks_.push_back({problem_->AddResidualBlock(cost, nullptr, gravity)});
}

void CalibrationProblem::addImuPriors(std::size_t imu) {
  const ImuPrior& prior = input_.imus[imu].prior;
  ImuState& state = state_.imus[imu];
  double* translation = state.reference_from_imu.translation_m.data();
  if (!prior.translation) addPrior(translation, 3, kZero.data(), options_.translation_sigma_m);
  holdTranslation(translation, prior.translation);
  if (!prior.gyroscope_bias)
    addPrior(state.gyroscope_bias_rad_s.data(), 3, kZero.data(), options_.gyroscope_bias_sigma_rad_s);
  if (!prior.accelerometer_bias)
    addPrior(state.accelerometer_bias_m_s2.data(), 3, kZero.data(), options_.accelerometer_bias_sigma_m_s2);
  for (const ceres::ResidualBlockId id : addDriftPriors(*problem_, options_, input_.imus[imu].noise, state))
    blocks_.push_back({id});
}

void CalibrationProblem::addMappingPriors(std::size_t imu, ReleaseStages stage) {
  const ImuPrior& prior = input_.imus[imu].prior;
  double *gyroscope = gyroscope_mappings_[imu].data(), *accelerometer = accelerometer_mappings_[imu].data();
  if (!prior.gyroscope_mapping) addPrior(gyroscope, 6, kIdentity.data(), options_.mapping_sigma);
  if (!prior.accelerometer_mapping) addPrior(accelerometer, 6, kIdentity.data(), options_.mapping_sigma);
  holdMapping(gyroscope, held_axes[imu].gyroscope, prior.gyroscope_mapping);
  holdMapping(accelerometer, held_axes[imu].accelerometer, prior.accelerometer_mapping);
  if (!turnsGyroscope(imu, stage)) return;
  double* rotation = state_.imus[imu].gyroscope_from_accelerometer.coeffs().data();
  auto* cost =
      new RotationPriorCost(Eigen::Quaterniond::Identity(),
                            Eigen::Vector3d::Constant(kRadPerDeg * options_.gyroscope_rotation_sigma_deg));
  blocks_.push_back({problem_->AddResidualBlock(cost, nullptr, rotation)});
}

// No IMU fills the gaps between views.
void CalibrationProblem::addSmoothness() {
  So3Spline& r = state_.world_from_imu_rotation;
  for (std::size_t k = 2; k < r.control_points.size(); ++k) {
    auto* cost =
        new SmoothRotationCost(r.knot_spacing_s, scales.smooth_rotation * options_.smooth_rotation_rad_s2);
    const auto block = [&](std::size_t i) { return r.control_points[i].coeffs().data(); };
    blocks_.push_back({problem_->AddResidualBlock(cost, nullptr, block(k - 2), block(k - 1), block(k))});
  }
  VectorSpline& p = state_.imu_in_world_m;
  for (std::size_t k = 2; k < p.control_points.size(); ++k) {
    auto* cost =
        new SmoothPositionCost(p.knot_spacing_s, scales.smooth_position * options_.smooth_position_m_s2);
    const auto block = [&](std::size_t i) { return p.control_points[i].data(); };
    blocks_.push_back({problem_->AddResidualBlock(cost, nullptr, block(k - 2), block(k - 1), block(k))});
  }
}

// The trajectory is the reference camera's own.
void CalibrationProblem::holdReferenceCamera() {
  CameraState& reference = state_.cameras[input_.reference_camera];
  for (double* block : {reference.reference_from_camera.rotation.coeffs().data(),
                        reference.reference_from_camera.translation_m.data(), &reference.time_offset_s}) {
    if (problem_->HasParameterBlock(block)) problem_->SetParameterBlockConstant(block);
  }
}

void CalibrationProblem::holdTranslation(double* translation_m, const std::optional<KnownVector>& known) {
  constexpr double kSigma_m = 1e-4;
  if (input_.imus.empty() || !problem_->HasParameterBlock(translation_m)) return;
  for (const Eigen::Vector3d& axis : held_axes[input_.reference_imu].leverless()) {
    auto* cost =
        new HeldTranslationCost(axis, known ? known->value : Eigen::Vector3d::Zero().eval(), kSigma_m);
    blocks_.push_back({problem_->AddResidualBlock(cost, nullptr, translation_m)});
  }
}

void CalibrationProblem::holdMapping(double* mapping, const std::vector<Eigen::Vector3d>& axes,
                                     const std::optional<KnownMapping>& known) {
  constexpr double kSigma = 1e-5;  // far below what could be measured
  if (!problem_->HasParameterBlock(mapping)) return;
  const Eigen::Matrix3d prior = known ? known->value : Eigen::Matrix3d::Identity();
  for (const Eigen::Vector3d& axis : axes) {
    blocks_.push_back({problem_->AddResidualBlock(new HeldAxisCost(axis, prior, kSigma), nullptr, mapping)});
  }
}

// Where nothing turns about some axis the gyroscope could take any turn about it.
bool CalibrationProblem::turnsGyroscope(std::size_t imu, ReleaseStages stage) const {
  return options_.gyroscope_rotation && stage == ReleaseStages::Mappings && held_axes[imu].gyroscope.empty();
}

}  // namespace evical
