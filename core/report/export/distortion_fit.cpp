#include "core/report/export/distortion_fit.h"

#include "core/base/error.h"
#include "core/geometry/camera_model.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace evical {
namespace {

constexpr double kLargestError_px = 2.0;  // such errors are in the corners: RMS is a fifth of them

struct Sight {
  Eigen::Vector2d pixel;
  Eigen::Vector3d ray;
};

// Rays of pixels over the whole image, edges included.
std::vector<Sight> sightsOf(const CameraIntrinsics& camera, int columns, int rows) {
  std::vector<Sight> sights;
  for (int row = 0; row < rows; ++row)
    for (int col = 0; col < columns; ++col) {
      const Eigen::Vector2d pixel((camera.resolution_px.width_px - 1.0) * col / (columns - 1),
                                  (camera.resolution_px.height_px - 1.0) * row / (rows - 1));
      if (const auto normalised = unproject(camera, pixel))
        sights.push_back({pixel, normalised->homogeneous()});
    }
  return sights;
}

using Parameters = Eigen::Matrix<double, 9, 1>;

CameraIntrinsics changed(CameraIntrinsics camera, const Parameters& step) {
  camera.focal_length_px += step.head<2>();
  camera.principal_point_px += step.segment<2>(2);
  for (std::size_t i = 0; i < 5; ++i) camera.distortion[i] += step[4 + static_cast<Eigen::Index>(i)];
  return camera;
}

struct Misfit {
  double sum_px2 = 0.0, worst_px = 0.0;
};

// Infinite where the camera does not see one of the rays at all.
Misfit misfitOf(const CameraIntrinsics& camera, const std::vector<Sight>& sights) {
  constexpr double kNotSeen = std::numeric_limits<double>::infinity();
  Misfit misfit;
  for (const Sight& sight : sights) {
    const auto pixel = project(camera, sight.ray);
    if (!pixel) return {kNotSeen, kNotSeen};
    const double distance_px = (*pixel - sight.pixel).norm();
    misfit.sum_px2 += distance_px * distance_px;
    misfit.worst_px = std::max(misfit.worst_px, distance_px);
  }
  return misfit;
}

// One damped step; `used` parameters of the nine.
Parameters stepOf(const CameraIntrinsics& camera, const std::vector<Sight>& sights, int used,
                  double damping) {
  Eigen::Matrix<double, 9, 9> information = Eigen::Matrix<double, 9, 9>::Zero();
  Parameters gradient = Parameters::Zero();
  for (const Sight& sight : sights) {
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

}  // namespace

FittedCamera fitDistortion(const CameraIntrinsics& camera, CameraModel model, int coefficients) {
  FittedCamera fitted{camera, 0.0, 0.0};
  fitted.camera.model = model;
  if (model != camera.model) fitted.camera.distortion = {};
  for (std::size_t i = static_cast<std::size_t>(coefficients); i < 5; ++i) fitted.camera.distortion[i] = 0.0;
  const std::vector<Sight> sights = sightsOf(camera, 41, 31);
  double error = misfitOf(fitted.camera, sights).sum_px2;
  if (!std::isfinite(error)) {  // those coefficients alone see less than the image: from a plain lens
    fitted.camera.distortion = {};
    error = misfitOf(fitted.camera, sights).sum_px2;
  }
  double damping = 1e-6;
  for (int iteration = 0; iteration < 200 && damping < 1e9; ++iteration) {
    const CameraIntrinsics trial =
        changed(fitted.camera, stepOf(fitted.camera, sights, 4 + coefficients, damping));
    const double trial_error = misfitOf(trial, sights).sum_px2;
    const bool better = trial_error < error;
    damping *= better ? 0.1 : 10.0;
    if (!better) continue;
    const bool settled = error - trial_error < 1e-14 * error;
    fitted.camera = trial;
    error = trial_error;
    if (settled) break;
  }
  const std::vector<Sight> check = sightsOf(camera, 161, 121);
  const Misfit misfit = misfitOf(fitted.camera, check);
  fitted.worst_px = misfit.worst_px;
  fitted.rms_px = std::sqrt(misfit.sum_px2 / static_cast<double>(std::max<std::size_t>(check.size(), 1)));
  return fitted;
}

CameraIntrinsics cameraFor(const RigCamera& camera, const KnownModels& known, ExportNotes& notes) {
  const CameraIntrinsics& own = camera.intrinsics;
  const bool radtan = own.model == CameraModel::PinholeRadtan;
  const bool third = radtan && own.distortion[4] != 0.0;
  if (radtan ? known.radtan && (!third || known.third_radial) : known.equidistant) return own;
  const CameraModel model = known.radtan && (radtan || !known.equidistant) ? CameraModel::PinholeRadtan
                                                                           : CameraModel::PinholeEquidistant;
  const int coefficients = model == CameraModel::PinholeRadtan && known.third_radial ? 5 : 4;
  const FittedCamera fitted = fitDistortion(own, model, coefficients);
  const char* have = third ? "radial-tangential distortion with k3"
                           : (radtan ? "radial-tangential distortion" : "equidistant distortion");
  if (!(fitted.worst_px <= kLargestError_px))
    throw badInput(
        fmt::format("result: cameras.{}.intrinsics", camera.name),
        fmt::format("{} has no place for {}, and the nearest lens that it knows is off by up to {:.3g} px",
                    known.program, have, fitted.worst_px),
        "Calibrate the intrinsics with a model that it knows");
  notes.push_back(
      fmt::format("{}: {} has no place for {}: refitted over the whole image as {} with {} coefficients, off "
                  "by {:.2g} px RMS, "
                  "{:.2g} px at most",
                  camera.name, known.program, have,
                  model == CameraModel::PinholeRadtan ? "radial-tangential" : "equidistant", coefficients,
                  fitted.rms_px, fitted.worst_px));
  return fitted.camera;
}

std::vector<double> distortionOf(const CameraIntrinsics& camera, int coefficients) {
  return {camera.distortion.begin(), camera.distortion.begin() + coefficients};
}

}  // namespace evical
