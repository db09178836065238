#include "core/optimisation/prior_residuals.h"

#include "core/optimisation/bias_knots.h"
#include "core/optimisation/known_values.h"
#include "core/optimisation/prior_cost.h"
#include "core/optimisation/trajectory_smoothness.h"
#include "core/optimisation/weak_priors.h"

#include <algorithm>
#include <initializer_list>
#include <optional>

namespace evical {
namespace {

ceres::CostFunction* priorCost(const QuantityInfo& info, const Eigen::Quaterniond& mean,
                               const Eigen::VectorXd& sigmas) {
  const bool local = info.shape == QuantityShape::LocalRotation;
  return new RotationPriorCost(mean, sigmas, local ? PriorAxes::Source : PriorAxes::Target);
}
template <class Value>
ceres::CostFunction* priorCost(const QuantityInfo&, const Value& mean, const Eigen::VectorXd& sigmas) {
  return new PriorCost(quantityNumbers(mean), sigmas);
}

template <class Row, class Prior>
bool isKnown([[maybe_unused]] const Row& row, [[maybe_unused]] const Prior& prior) {
  if constexpr (Row::kHasPrior) return row.prior(prior).has_value();
  return false;
}

// Weak priors on these quantities of one sensor or board; the session's own priors take precedence.
template <class Rows, class State, class Prior>
void addWeakPriors(ProblemBuilder& builder, const Rows& rows, std::initializer_list<QuantityId> ids,
                   const PriorOwner& owner, const Prior& prior, State& state) {
  const State none;
  forEachQuantity(rows, [&](const auto& row) {
    double* const block = builder.parameters.of(row.value(state));
    if (std::ranges::find(ids, row.info.id) == ids.end() || !builder.has(block) || isKnown(row, prior))
      return;
    const auto mean = row.value(none);
    const auto count = static_cast<Eigen::Index>(quantityParts(row.info, mean).size());
    const double sigma = weakSigma(row.info, builder.options, owner).value();
    builder.addPrior(priorCost(row.info, mean, Eigen::VectorXd::Constant(count, sigma)), {block});
  });
}

void holdTranslation(ProblemBuilder& builder, double* translation_m,
                     const std::optional<KnownVector>& known) {
  constexpr double kSigma_m = 1e-4;
  if (builder.input.imus.empty() || !builder.has(translation_m)) return;
  for (const Eigen::Vector3d& axis :
       builder.weights.held_axes[builder.input.reference_imu].axesWithoutRotation()) {
    builder.addPrior(
        new HeldTranslationCost(axis, known ? known->value : Eigen::Vector3d::Zero().eval(), kSigma_m),
        {translation_m});
  }
}

void addCameraPriors(ProblemBuilder& builder) {
  std::vector<CameraState>& cameras = builder.parameters.moved().cameras;
  const auto add = [&](std::size_t i, std::initializer_list<QuantityId> ids) {
    const CameraData& data = builder.input.cameras[i];
    const PriorOwner owner{data.lens.detection_intrinsics->resolution_px.height_px};
    addWeakPriors(builder, kCameraQuantities, ids, owner, data.prior, cameras[i]);
  };
  for (std::size_t i = 0; i < cameras.size(); ++i)
    add(i, {QuantityId::EdgeLocalisationBias, QuantityId::SlowEdgeLocalisationBias});
  for (std::size_t i = 0; i < cameras.size(); ++i)
    if (builder.rolls(i)) add(i, {QuantityId::LineDelay});
  for (std::size_t i = 0; i < cameras.size(); ++i)
    if (builder.exposuresVary(i)) add(i, {QuantityId::ExposureShare});
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    IntrinsicsBlock* block = builder.parameters.intrinsics(i);
    if (block != nullptr && builder.parameters.ownsSensor(i) && builder.has(block->data()))
      builder.residuals.push_back({block->addPrior(builder.problem)});
  }
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const CameraData& data = builder.input.cameras[i];
    if (data.same_sensor_as) continue;  // one prior per sensor
    add(i, {QuantityId::Translation});
    holdTranslation(builder, cameras[i].reference_from_camera.translation_m.data(), data.prior.translation);
    if (builder.drifts(data.prior)) add(i, {QuantityId::TimeOffsetDrift});
  }
}

void addImuPriors(ProblemBuilder& builder, std::size_t imu) {
  const ImuPrior& prior = builder.input.imus[imu].prior;
  ImuState& state = builder.parameters.moved().imus[imu];
  const auto add = [&](std::initializer_list<QuantityId> ids) {
    addWeakPriors(builder, kImuQuantities, ids, {}, prior, state);
  };
  add({QuantityId::Translation});
  holdTranslation(builder, state.reference_from_imu.translation_m.data(), prior.translation);
  if (builder.drifts(prior)) add({QuantityId::TimeOffsetDrift});
  add({QuantityId::GyroscopeBias, QuantityId::AccelerometerBias});
  const ImuNoise& noise = builder.input.imus[imu].noise;
  for (const ceres::ResidualBlockId id : addDriftPriors(builder.problem, builder.options, noise, state))
    builder.residuals.push_back({id});
  if (builder.stage != ParameterStages::Mappings) return;
  add({QuantityId::GyroscopeScaleMisalignment, QuantityId::AccelerometerScaleMisalignment,
       QuantityId::AccelerometerDelay});
  if (builder.turnsGyroscope(imu)) add({QuantityId::GyroscopeRotation});
}

// Possible deviation of a board from its given size: both of its directions were measured.
void addBoardPriors(ProblemBuilder& builder, std::size_t index) {
  const PriorOwner owner{0, &builder.input.boardAt(index),
                         builder.input.spacingSigma(index, builder.options.board_spacing_sigma)};
  const auto add = [&](std::initializer_list<QuantityId> ids) {
    addWeakPriors(builder, kBoardQuantities, ids, owner, NoPrior{},
                  builder.parameters.moved().boardAt(index));
  };
  if (index > 0) add({QuantityId::Translation});
  if (builder.options.board_bow)
    add({QuantityId::RowCurvature, QuantityId::ColumnCurvature, QuantityId::Twist});
  if (builder.options.free_board_size) add({QuantityId::Scale, QuantityId::Stretch});
}

}  // namespace

void addPriors(ProblemBuilder& builder) {
  CalibrationState& state = builder.parameters.moved();
  addCameraPriors(builder);
  for (std::size_t i = 0; i < state.imus.size(); ++i) addImuPriors(builder, i);
  for (std::size_t i = 0; i < builder.input.boardCount(); ++i) addBoardPriors(builder, i);
  double* gravity = state.gravity_in_world_m_s2.data();
  if (builder.options.free_gravity_norm && builder.has(gravity))
    builder.addPrior(new NormCost(builder.input.gravity_norm_m_s2, builder.options.gravity_norm_sigma_m_s2),
                     {gravity});
}

// Adds the session's priors, and fixes given values. This includes a reference: its clock's drift has a block
// even if it is not estimated.
void addKnownValues(ProblemBuilder& builder) {
  forEachSensorKind([&](auto kind) {
    auto& sensors = kind.of(builder.parameters.moved());
    for (std::size_t i = 0; i < sensors.size(); ++i)
      forEachPriorQuantity(kind.rows(), [&](const auto& row) {
        const auto known =
            effectivePrior(row.info, builder.options, row.prior(kind.of(builder.input)[i].prior));
        double* block = builder.parameters.of(row.value(sensors[i]));
        if (!known || !builder.has(block)) return;
        if (known->isGiven())
          builder.hold(block);
        else
          builder.addPrior(priorCost(row.info, known->value, quantityNumbers(*known->sigma)), {block});
      });
  });
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
