#include "core/optimisation/lens_prior.h"

#include "core/geometry/camera_model.h"
#include "core/geometry/sphere_lens.h"
#include "core/optimisation/optimisation_options.h"

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
