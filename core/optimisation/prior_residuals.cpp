#include "core/optimisation/prior_residuals.h"

#include "core/data/board_bow.h"
#include "core/numerics/angles.h"
#include "core/optimisation/bias_knots.h"
#include "core/optimisation/known_values.h"
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

void addDriftPrior(ProblemBuilder& builder, const SensorPrior& prior, double& time_offset_drift_ppm) {
  if (builder.drifts(prior) && !prior.time_offset_drift)
    addPrior(builder, &time_offset_drift_ppm, 1, kZero.data(), builder.options.time_offset_drift_sigma_ppm);
}

void addCameraPriors(ProblemBuilder& builder) {
  std::vector<CameraState>& cameras = builder.parameters.moved().cameras;
  for (CameraState& camera : cameras) {
    addPrior(builder, &camera.edge_lead_px, 1, kZero.data(), builder.options.edge_lead_sigma_px);
    addPrior(builder, &camera.slow_edge_lead_px, 1, kZero.data(), builder.options.slow_edge_lead_sigma_px);
  }
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (builder.rolls(i))
      addPrior(builder, &cameras[i].line_delay_us, 1, kZero.data(),
               1e3 * builder.options.longest_readout_ms /
                   builder.input.cameras[i].lens.seen_with->resolution_px.height_px);
  }
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (builder.exposuresVary(i))
      addPrior(builder, &cameras[i].exposure_share, 1, kZero.data(), builder.options.exposure_share_sigma);
  }
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    IntrinsicsBlock* block = builder.parameters.intrinsics(i);
    if (block != nullptr && builder.parameters.ownsSensor(i) && builder.has(block->data()))
      builder.residuals.push_back({block->addPrior(builder.problem)});
  }
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (builder.input.cameras[i].same_sensor_as) continue;  // what is known of a sensor counts once
    const std::optional<KnownVector>& known = builder.input.cameras[i].prior.translation;
    double* translation = cameras[i].reference_from_camera.translation_m.data();
    if (!known) addPrior(builder, translation, 3, kZero.data(), builder.options.translation_sigma_m);
    holdTranslation(builder, translation, known);
    addDriftPrior(builder, builder.input.cameras[i].prior, cameras[i].time_offset_drift_ppm);
  }
}

void addImuPriors(ProblemBuilder& builder, std::size_t imu) {
  const OptimisationOptions& options = builder.options;
  const ImuPrior& prior = builder.input.imus[imu].prior;
  ImuState& state = builder.parameters.moved().imus[imu];
  double* translation = state.reference_from_imu.translation_m.data();
  if (!prior.translation) addPrior(builder, translation, 3, kZero.data(), options.translation_sigma_m);
  holdTranslation(builder, translation, prior.translation);
  addDriftPrior(builder, prior, state.time_offset_drift_ppm);
  if (!prior.gyroscope_bias)
    addPrior(builder, state.gyroscope_bias_rad_s.data(), 3, kZero.data(), options.gyroscope_bias_sigma_rad_s);
  if (!prior.accelerometer_bias)
    addPrior(builder, state.accelerometer_bias_m_s2.data(), 3, kZero.data(),
             options.accelerometer_bias_sigma_m_s2);
  const ImuNoise& noise = builder.input.imus[imu].noise;
  for (const ceres::ResidualBlockId id : addDriftPriors(builder.problem, options, noise, state))
    builder.residuals.push_back({id});
}

void addIntrinsicsPriors(ProblemBuilder& builder, std::size_t imu) {
  const ImuPrior& prior = builder.input.imus[imu].prior;
  const StillAxes& held = builder.weights.held_axes[imu];
  const double sigma = builder.options.mapping_sigma;
  ImuState& state = builder.parameters.moved().imus[imu];
  double *gyroscope = builder.parameters.of(state.gyroscope_mapping),
         *accelerometer = builder.parameters.of(state.accelerometer_mapping);
  if (!prior.gyroscope_mapping) addPrior(builder, gyroscope, 6, kIdentity.data(), sigma);
  if (!prior.accelerometer_mapping) addPrior(builder, accelerometer, 6, kIdentity.data(), sigma);
  if (!prior.accelerometer_delay)
    addPrior(builder, &state.accelerometer_delay_s, 1, kZero.data(),
             builder.options.accelerometer_delay_sigma_s);
  holdMapping(builder, gyroscope, held.gyroscope, prior.gyroscope_mapping);
  holdMapping(builder, accelerometer, held.accelerometer, prior.accelerometer_mapping);
  if (!builder.turnsGyroscope(imu) || prior.gyroscope_rotation) return;
  const Eigen::Vector3d sigma_rad =
      Eigen::Vector3d::Constant(kRadPerDeg * builder.options.gyroscope_rotation_sigma_deg);
  builder.addPrior(new RotationPriorCost(Eigen::Quaterniond::Identity(), sigma_rad),
                   {builder.parameters.of(state.gyroscope_from_accelerometer)});
}

ceres::CostFunction* priorCost(const QuantityInfo&, const KnownNumber& known) {
  return new PriorCost(&known.value, 1, *known.sigma);
}
ceres::CostFunction* priorCost(const QuantityInfo&, const KnownVector& known) {
  return new PriorCost(known.value, *known.sigma);
}
ceres::CostFunction* priorCost(const QuantityInfo&, const KnownMapping& known) {
  return new PriorCost(quantityNumbers(known.value), quantityNumbers(*known.sigma));
}
ceres::CostFunction* priorCost(const QuantityInfo& info, const KnownRotation& known) {
  const bool local = info.shape == QuantityShape::LocalRotation;
  return new RotationPriorCost(known.value, *known.sigma, local ? PriorAxes::Source : PriorAxes::Target);
}

// What the session knows of a sensor, weighed or held.
template <class Rows, class Prior, class State>
void addKnownValues(ProblemBuilder& builder, const Rows& rows, const Prior& prior, State& state) {
  forEachPriorQuantity(rows, [&](const auto& row) {
    const auto known = effectivePrior(row.info, builder.options, row.prior(prior));
    double* block = builder.parameters.of(row.value(state));
    if (!known || !builder.has(block)) return;
    if (known->isGiven())
      builder.hold(block);
    else
      builder.addPrior(priorCost(row.info, *known), {block});
  });
}

// How far a board may be from what is said of it: both of its directions were measured.
void addBoardPriors(ProblemBuilder& builder, std::size_t index) {
  constexpr double kWithin_m = 100.0;  // what no view tells of a board's place has an end
  BoardState& board = builder.parameters.moved().boardAt(index);
  if (index > 0) addPrior(builder, board.world_from_board.translation_m.data(), 3, kZero.data(), kWithin_m);
  const auto addBow = [&](double& curvature_1_m, const QuantityInfo& info) {
    const double height_m = 1e-3 * builder.options.board_bow_sigma_mm;
    addPrior(builder, &curvature_1_m, 1, kZero.data(),
             height_m / bowHeight_m2(info, builder.input.boardAt(index)));
  };
  if (builder.options.board_bow)
    forEachSheetQuantity([&](const auto& row) {
      if (row.info.release == QuantityRelease::BoardBow) addBow(row.value(board), row.info);
    });
  if (!builder.options.free_board_size) return;
  constexpr double kSize = 1.0;
  const double spacing_sigma = builder.input.spacingSigma(index, builder.options.board_spacing_sigma);
  addPrior(builder, &board.scale, 1, &kSize, spacing_sigma);
  addPrior(builder, &board.stretch, 1, kZero.data(), boardStretchSigma(spacing_sigma));
}

}  // namespace

void addPriors(ProblemBuilder& builder) {
  CalibrationState& state = builder.parameters.moved();
  addCameraPriors(builder);
  for (std::size_t i = 0; i < state.imus.size(); ++i) {
    addImuPriors(builder, i);
    if (builder.stage == ReleaseStages::Mappings) addIntrinsicsPriors(builder, i);
  }
  for (std::size_t i = 0; i < builder.input.boardCount(); ++i) addBoardPriors(builder, i);
  double* gravity = state.gravity_in_world_m_s2.data();
  if (builder.options.free_gravity_norm && builder.has(gravity))
    builder.addPrior(new NormCost(builder.input.gravity_norm_m_s2, builder.options.gravity_norm_sigma_m_s2),
                     {gravity});
}

// A reference has no blocks of a place of its own, or they are held anyway.
void addKnownValues(ProblemBuilder& builder) {
  CalibrationState& state = builder.parameters.moved();
  for (std::size_t i = 0; i < state.cameras.size(); ++i)
    if (!builder.input.isReferenceCamera(i))
      addKnownValues(builder, kCameraQuantities, builder.input.cameras[i].prior, state.cameras[i]);
  for (std::size_t i = 0; i < state.imus.size(); ++i)
    addKnownValues(builder, kImuQuantities, builder.input.imus[i].prior, state.imus[i]);
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
