#include "core/optimisation/prior_residuals.h"

#include "core/numerics/angles.h"
#include "core/optimisation/bias_knots.h"
#include "core/optimisation/prior_cost.h"
#include "core/optimisation/smoothness_cost.h"

#include <array>
#include <optional>

namespace evical {
namespace {

constexpr std::array<double, 6> kZero = {};
constexpr std::array<double, 6> kIdentity = {1.0, 0.0, 0.0, 1.0, 0.0, 1.0};

void addPrior(ProblemBuilder& builder, double* block, int size, const double* mean, double sigma) {
  if (builder.has(block)) builder.addPrior(new PriorCost(mean, size, sigma), {block});
}

void holdTranslation(ProblemBuilder& builder, double* translation_m,
                     const std::optional<KnownVector>& known) {
  constexpr double kSigma_m = 1e-4;
  if (builder.input.imus.empty() || !builder.has(translation_m)) return;
  for (const Eigen::Vector3d& axis : builder.weights.held_axes[builder.input.reference_imu].leverless()) {
    builder.addPrior(
        new HeldTranslationCost(axis, known ? known->value : Eigen::Vector3d::Zero().eval(), kSigma_m),
        {translation_m});
  }
}

void holdMapping(ProblemBuilder& builder, double* mapping, const std::vector<Eigen::Vector3d>& axes,
                 const std::optional<KnownMapping>& known) {
  constexpr double kSigma = 1e-5;  // far below what could be measured
  if (!builder.has(mapping)) return;
  const Eigen::Matrix3d prior = known ? known->value : Eigen::Matrix3d::Identity();
  for (const Eigen::Vector3d& axis : axes) builder.addPrior(new HeldAxisCost(axis, prior, kSigma), {mapping});
}

void addCameraPriors(ProblemBuilder& builder) {
  std::vector<CameraState>& cameras = builder.parameters.moved().cameras;
  for (CameraState& camera : cameras) {
    addPrior(builder, &camera.edge_lead_px, 1, kZero.data(), builder.options.edge_lead_sigma_px);
    addPrior(builder, &camera.edge_lead_growth_px, 1, kZero.data(),
             builder.options.edge_lead_growth_sigma_px);
  }
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    IntrinsicsBlock* block = builder.parameters.intrinsics(i);
    if (block != nullptr && builder.has(block->data()))
      builder.residuals.push_back({block->addPrior(builder.problem)});
  }
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::optional<KnownVector>& known = builder.input.cameras[i].prior.translation;
    double* translation = cameras[i].reference_from_camera.translation_m.data();
    if (!known) addPrior(builder, translation, 3, kZero.data(), builder.options.translation_sigma_m);
    holdTranslation(builder, translation, known);
  }
}

void addImuPriors(ProblemBuilder& builder, std::size_t imu) {
  const OptimisationOptions& options = builder.options;
  const ImuPrior& prior = builder.input.imus[imu].prior;
  ImuState& state = builder.parameters.moved().imus[imu];
  double* translation = state.reference_from_imu.translation_m.data();
  if (!prior.translation) addPrior(builder, translation, 3, kZero.data(), options.translation_sigma_m);
  holdTranslation(builder, translation, prior.translation);
  if (!prior.gyroscope_bias)
    addPrior(builder, state.gyroscope_bias_rad_s.data(), 3, kZero.data(), options.gyroscope_bias_sigma_rad_s);
  if (!prior.accelerometer_bias)
    addPrior(builder, state.accelerometer_bias_m_s2.data(), 3, kZero.data(),
             options.accelerometer_bias_sigma_m_s2);
  const ImuNoise& noise = builder.input.imus[imu].noise;
  for (const ceres::ResidualBlockId id : addDriftPriors(builder.problem, options, noise, state))
    builder.residuals.push_back({id});
}

void addMappingPriors(ProblemBuilder& builder, std::size_t imu) {
  const ImuPrior& prior = builder.input.imus[imu].prior;
  const StillAxes& held = builder.weights.held_axes[imu];
  const double sigma = builder.options.mapping_sigma;
  double *gyroscope = builder.parameters.gyroscopeMapping(imu),
         *accelerometer = builder.parameters.accelerometerMapping(imu);
  if (!prior.gyroscope_mapping) addPrior(builder, gyroscope, 6, kIdentity.data(), sigma);
  if (!prior.accelerometer_mapping) addPrior(builder, accelerometer, 6, kIdentity.data(), sigma);
  holdMapping(builder, gyroscope, held.gyroscope, prior.gyroscope_mapping);
  holdMapping(builder, accelerometer, held.accelerometer, prior.accelerometer_mapping);
  if (!builder.turnsGyroscope(imu)) return;
  const Eigen::Vector3d sigma_rad =
      Eigen::Vector3d::Constant(kRadPerDeg * builder.options.gyroscope_rotation_sigma_deg);
  builder.addPrior(new RotationPriorCost(Eigen::Quaterniond::Identity(), sigma_rad),
                   {builder.parameters.moved().imus[imu].gyroscope_from_accelerometer.coeffs().data()});
}

Eigen::Matrix<double, 6, 1> upperTriangle(const Eigen::Matrix3d& mapping) {
  Eigen::Matrix<double, 6, 1> entries;
  parametersFromMapping(mapping, entries.data());
  return entries;
}

// Without a cost the value is given.
void addKnown(ProblemBuilder& builder, double* block, ceres::CostFunction* cost) {
  if (cost != nullptr)
    builder.addPrior(cost, {block});
  else
    builder.hold(block);
}

void addKnownVector(ProblemBuilder& builder, const std::optional<KnownVector>& known,
                    Eigen::Vector3d& block) {
  if (!known) return;
  addKnown(builder, block.data(), known->isGiven() ? nullptr : new PriorCost(known->value, *known->sigma));
}

void addKnownMapping(ProblemBuilder& builder, const std::optional<KnownMapping>& known, double* mapping) {
  if (!known) return;
  addKnown(
      builder, mapping,
      known->isGiven() ? nullptr : new PriorCost(upperTriangle(known->value), upperTriangle(*known->sigma)));
}

void addKnownPlace(ProblemBuilder& builder, const SensorPrior& prior, RigidTransform& pose,
                   double& time_offset_s) {
  double* rotation = pose.rotation.coeffs().data();
  if (!builder.has(rotation)) return;  // the sensor is not in yet
  if (const auto& known = prior.rotation)
    addKnown(builder, rotation,
             known->isGiven() ? nullptr : new RotationPriorCost(known->value, *known->sigma));
  addKnownVector(builder, prior.translation, pose.translation_m);
  const std::optional<KnownNumber> offset =
      builder.options.free_time_offsets ? prior.time_offset : heldTimeOffset(prior);
  if (offset)
    addKnown(builder, &time_offset_s,
             offset->isGiven() ? nullptr : new PriorCost(&offset->value, 1, *offset->sigma));
}

}  // namespace

void addPriors(ProblemBuilder& builder) {
  CalibrationState& state = builder.parameters.moved();
  addCameraPriors(builder);
  for (std::size_t i = 0; i < state.imus.size(); ++i) {
    addImuPriors(builder, i);
    if (builder.stage == ReleaseStages::Mappings) addMappingPriors(builder, i);
  }
  double* gravity = state.gravity_in_world_m_s2.data();
  if (builder.options.free_gravity_norm && builder.has(gravity))
    builder.addPrior(new NormCost(builder.input.gravity_norm_m_s2, builder.options.gravity_norm_sigma_m_s2),
                     {gravity});
}

void addKnownValues(ProblemBuilder& builder) {
  CalibrationState& state = builder.parameters.moved();
  for (std::size_t i = 0; i < state.cameras.size(); ++i) {
    if (!builder.input.isReferenceCamera(i))
      addKnownPlace(builder, builder.input.cameras[i].prior, state.cameras[i].reference_from_camera,
                    state.cameras[i].time_offset_s);
  }
  for (std::size_t i = 0; i < state.imus.size(); ++i) {
    const ImuPrior& prior = builder.input.imus[i].prior;
    ImuState& imu = state.imus[i];
    if (!builder.has(imu.gyroscope_bias_rad_s.data())) continue;
    if (!builder.isReference(i)) addKnownPlace(builder, prior, imu.reference_from_imu, imu.time_offset_s);
    addKnownVector(builder, prior.gyroscope_bias, imu.gyroscope_bias_rad_s);
    addKnownVector(builder, prior.accelerometer_bias, imu.accelerometer_bias_m_s2);
    addKnownMapping(builder, prior.gyroscope_mapping, builder.parameters.gyroscopeMapping(i));
    addKnownMapping(builder, prior.accelerometer_mapping, builder.parameters.accelerometerMapping(i));
  }
}

void addSmoothness(ProblemBuilder& builder) {
  const NoiseScales& scales = builder.weights.scales;
  So3Spline& r = builder.parameters.moved().world_from_imu_rotation;
  for (std::size_t k = 2; k < r.control_points.size(); ++k) {
    auto* cost = new SmoothRotationCost(r.knot_spacing_s,
                                        scales.smooth_rotation * builder.options.smooth_rotation_rad_s2);
    const auto block = [&](std::size_t i) { return r.control_points[i].coeffs().data(); };
    builder.addPrior(cost, {block(k - 2), block(k - 1), block(k)});
  }
  VectorSpline& p = builder.parameters.moved().imu_in_world_m;
  for (std::size_t k = 2; k < p.control_points.size(); ++k) {
    auto* cost = new SmoothPositionCost(p.knot_spacing_s,
                                        scales.smooth_position * builder.options.smooth_position_m_s2);
    const auto block = [&](std::size_t i) { return p.control_points[i].data(); };
    builder.addPrior(cost, {block(k - 2), block(k - 1), block(k)});
  }
}

}  // namespace evical
