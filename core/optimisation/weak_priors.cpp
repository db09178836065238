#include "core/optimisation/weak_priors.h"

#include "core/data/board_bow.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/sphere_lens.h"
#include "core/numerics/angles.h"

namespace evical {
namespace {

// Models with spheres: f and xi are strongly correlated, so the prior is on f / (1 + xi).
void holdScaleRatherThanLength(const CameraIntrinsics& camera, IntrinsicsMatrix& covariance) {
  constexpr int kXi = 4;
  if (!hasCentresApart(camera.model)) return;
  const Eigen::Vector2d by_xi = idealFocalLength_px(camera);
  covariance.topLeftCorner<2, 2>() += covariance(kXi, kXi) * by_xi * by_xi.transpose();
  covariance.block<2, 1>(0, kXi) = covariance(kXi, kXi) * by_xi;
  covariance.block<1, 2>(kXi, 0) = covariance.block<2, 1>(0, kXi).transpose();
}

}  // namespace

std::optional<double> weakSigma(const QuantityInfo& info, const OptimisationOptions& options,
                                const PriorOwner& owner) {
  constexpr double kBoardWithin_m = 100.0;  // limits a board without views
  switch (info.id) {
    case QuantityId::Translation:
      return info.owner == QuantityOwner::Board ? kBoardWithin_m : options.translation_sigma_m;
    case QuantityId::TimeOffsetDrift:
      return options.time_offset_drift_sigma_ppm;
    case QuantityId::LineDelay:
      return 1e3 * options.max_readout_ms / owner.image_height_px;
    case QuantityId::ExposureShare:
      return options.exposure_share_sigma;
    case QuantityId::EdgeLocalisationBias:
      return options.edge_localisation_bias_sigma_px;
    case QuantityId::SlowEdgeLocalisationBias:
      return options.slow_edge_localisation_bias_sigma_px;
    case QuantityId::GyroscopeBias:
      return options.gyroscope_bias_sigma_rad_s;
    case QuantityId::AccelerometerBias:
      return options.accelerometer_bias_sigma_m_s2;
    case QuantityId::GyroscopeScaleMisalignment:
    case QuantityId::AccelerometerScaleMisalignment:
      return options.mapping_sigma;
    case QuantityId::AccelerometerDelay:
      return options.accelerometer_delay_sigma_s;
    case QuantityId::GyroscopeRotation:
      return kRadPerDeg * options.gyroscope_rotation_sigma_deg;
    case QuantityId::Scale:
      return owner.spacing_sigma;
    case QuantityId::Stretch:
      return boardStretchSigma(owner.spacing_sigma);
    case QuantityId::RowCurvature:
    case QuantityId::ColumnCurvature:
    case QuantityId::Twist:
      return 1e-3 * options.board_bow_sigma_mm / bowHeight_m2(info.id, *owner.board);
    case QuantityId::Rotation:
    case QuantityId::TimeOffset:
    case QuantityId::Intrinsics:  // LensPrior
    case QuantityId::Gravity:
    case QuantityId::Latency:
      break;
  }
  return std::nullopt;
}

IntrinsicsMatrix lensPriorCovariance(const CameraLens& lens, const OptimisationOptions& options) {
  IntrinsicsVector weak = IntrinsicsVector::Constant(options.camera_distortion_sigma);
  weak.head<2>() = options.camera_focal_length_sigma * lens.detection_intrinsics->focal_length_px;
  weak.segment<2>(2).setConstant(options.camera_principal_point_sigma_px);
  IntrinsicsMatrix covariance = weak.cwiseAbs2().asDiagonal();
  if (!lens.given_with) {
    holdScaleRatherThanLength(*lens.detection_intrinsics, covariance);
    return covariance;
  }
  const IntrinsicsMatrix given = lens.given_with->covariance();
  // Rounded correlations may not be positive definite; this is far below their rounding.
  constexpr double kRounded = 1e-3;
  for (int i = 0; i < kIntrinsicsCount; ++i) {
    if (given(i, i) <= 0.0) continue;
    for (int j = 0; j < kIntrinsicsCount; ++j)
      if (given(j, j) > 0.0) covariance(i, j) = given(i, j) * (i == j ? 1.0 + kRounded : 1.0);
  }
  return covariance;
}

}  // namespace evical
