#include "core/geometry/lens_fit.h"

#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/sphere_lens.h"
#include "core/numerics/angles.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace evical {
namespace {

constexpr int kColumns = 41, kRows = 31;  // grid of fitted rays

struct DetectionSetup {
  Eigen::Vector2d pixel;
  Eigen::Vector3d ray;
};

struct Sights {
  std::vector<DetectionSetup> seen;
  bool whole_image = true;
};

// Rays of pixels over the whole image including its edges, as far as `model` can project them.
Sights sightsOf(const CameraIntrinsics& camera, CameraModel model, int columns, int rows) {
  const double min_z = isSphereModel(model) ? -1.0 : std::cos(85.0 * kRadPerDeg);
  Sights sights;
  for (int row = 0; row < rows; ++row)
    for (int col = 0; col < columns; ++col) {
      const Eigen::Vector2d pixel((camera.resolution_px.width_px - 1.0) * col / (columns - 1),
                                  (camera.resolution_px.height_px - 1.0) * row / (rows - 1));
      const auto ray = unprojectRay(camera, pixel);
      if (!ray) continue;  // no ray in the camera's own model either
      if (ray->z() >= min_z)
        sights.seen.push_back({pixel, *ray});
      else
        sights.whole_image = false;
    }
  return sights;
}

using Parameters = Eigen::Matrix<double, 9, 1>;

CameraIntrinsics changed(const CameraIntrinsics& camera, const Parameters& step) {
  Parameters numbers;
  writeIntrinsics(camera, numbers.data());
  numbers += step;
  const IntrinsicsBounds bounds = intrinsicsBounds(camera.model);
  for (std::size_t i = 0; i < 9; ++i) {
    double& number = numbers[static_cast<Eigen::Index>(i)];
    number = std::clamp(number, bounds.lower[i], bounds.upper[i]);
  }
  return intrinsicsFrom(numbers.data(), camera.model, camera.resolution_px);
}

struct Misfit {
  double sum_px2 = 0.0, worst_px = 0.0;
};

// Infinite if the camera cannot project one of the rays.
Misfit misfitOf(const CameraIntrinsics& camera, const std::vector<DetectionSetup>& sights) {
  constexpr double kNotSeen = std::numeric_limits<double>::infinity();
  Misfit misfit;
  for (const DetectionSetup& sight : sights) {
    const auto pixel = project(camera, sight.ray);
    if (!pixel) return {kNotSeen, kNotSeen};
    const double distance_px = (*pixel - sight.pixel).norm();
    misfit.sum_px2 += distance_px * distance_px;
    misfit.worst_px = std::max(misfit.worst_px, distance_px);
  }
  return misfit;
}

// One damped step; `used` parameters of the nine.
Parameters stepOf(const CameraIntrinsics& camera, const std::vector<DetectionSetup>& sights, int used,
                  double damping) {
  Eigen::Matrix<double, 9, 9> information = Eigen::Matrix<double, 9, 9>::Zero();
  Parameters gradient = Parameters::Zero();
  for (const DetectionSetup& sight : sights) {
    IntrinsicsJacobian jacobian;
    const auto pixel = project(camera, sight.ray, nullptr, &jacobian);
    if (!pixel) continue;
    information += jacobian.transpose() * jacobian;
    gradient += jacobian.transpose() * (sight.pixel - *pixel);
  }
  for (int i = 0; i < 9; ++i) information(i, i) *= 1.0 + damping;
  Parameters step = Parameters::Zero();
  step.head(used) = information.topLeftCorner(used, used).ldlt().solve(gradient.head(used));
  return step;
}

CameraIntrinsics startOf(const CameraIntrinsics& camera, CameraModel model, int coefficients,
                         const std::vector<DetectionSetup>& sights) {
  const CameraIntrinsics plain = plainLens(camera, model);
  if (model != camera.model) return plain;
  CameraIntrinsics start = camera;
  for (std::size_t i = static_cast<std::size_t>(coefficients); i < 5; ++i) start.distortion[i] = 0.0;
  // These coefficients alone may not cover the whole image.
  return std::isfinite(misfitOf(start, sights).sum_px2) ? start : plain;
}

}  // namespace

CameraIntrinsics plainLens(const CameraIntrinsics& like, CameraModel model) {
  CameraIntrinsics plain = like;
  plain.model = model;
  plain.distortion = {};
  plain.focal_length_px = idealFocalLength_px(like);
  if (model == CameraModel::DoubleSphere) plain.distortion = {0.0, 0.5, 0.0, 0.0, 0.0};
  if (model == CameraModel::Eucm) plain.distortion = {0.5, 1.0, 0.0, 0.0, 0.0};
  if (model == CameraModel::OmniRadtan) {
    plain.distortion = {1.0, 0.0, 0.0, 0.0, 0.0};
    plain.focal_length_px *= 2.0;
  }
  return plain;
}

LensFit fitLens(const CameraIntrinsics& camera, CameraModel model, int coefficients) {
  const std::vector<DetectionSetup> sights = sightsOf(camera, model, kColumns, kRows).seen;
  LensFit fit;
  fit.camera = startOf(camera, model, coefficients, sights);
  double error = misfitOf(fit.camera, sights).sum_px2;
  double damping = 1e-6;
  for (int iteration = 0; iteration < 200 && damping < 1e9; ++iteration) {
    const CameraIntrinsics trial = changed(fit.camera, stepOf(fit.camera, sights, 4 + coefficients, damping));
    const double trial_error = misfitOf(trial, sights).sum_px2;
    const bool better = trial_error < error;
    damping *= better ? 0.1 : 10.0;
    if (!better) continue;
    const bool settled = error - trial_error < 1e-14 * error;
    fit.camera = trial;
    error = trial_error;
    if (settled) break;
  }
  const Sights check = sightsOf(camera, model, 161, 121);
  const Misfit misfit = misfitOf(fit.camera, check.seen);
  fit.whole_image = check.whole_image;
  fit.worst_px = misfit.worst_px;
  fit.rms_px = std::sqrt(misfit.sum_px2 / static_cast<double>(std::max<std::size_t>(check.seen.size(), 1)));
  return fit;
}

}  // namespace evical
