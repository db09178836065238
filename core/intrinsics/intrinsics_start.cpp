#include "core/intrinsics/intrinsics_start.h"

#include "core/geometry/camera_model.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <opencv2/calib3d.hpp>

#include <algorithm>

namespace evical {
namespace {

constexpr int kFitted = 8;  // all but k3

void step(CameraIntrinsics& camera, const Eigen::Matrix<double, kFitted, 1>& by) {
  camera.focal_length_px += by.head<2>();
  camera.principal_point_px += by.segment<2>(2);
  for (std::size_t i = 0; i < 4; ++i) camera.distortion[i] += by[static_cast<Eigen::Index>(4 + i)];
}

// One Gauss-Newton step towards the pixels of the rays; false where that leads nowhere.
bool fitStep(const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& pixels_and_rays,
             CameraIntrinsics& camera) {
  Eigen::Matrix<double, kFitted, kFitted> matrix = Eigen::Matrix<double, kFitted, kFitted>::Zero();
  Eigen::Matrix<double, kFitted, 1> vector = Eigen::Matrix<double, kFitted, 1>::Zero();
  for (const auto& [pixel, ray] : pixels_and_rays) {
    IntrinsicsJacobian jacobian;
    const auto projected = project(camera, ray.homogeneous(), nullptr, &jacobian);
    if (!projected) continue;
    matrix += jacobian.leftCols<kFitted>().transpose() * jacobian.leftCols<kFitted>();
    vector -= jacobian.leftCols<kFitted>().transpose() * (*projected - pixel);
  }
  constexpr double kDamping = 1e-9;
  matrix.diagonal() *= 1.0 + kDamping;
  const Eigen::Matrix<double, kFitted, 1> by = matrix.ldlt().solve(vector);
  if (!by.allFinite()) return false;
  step(camera, by);
  return camera.focal_length_px.minCoeff() > 1.0;
}

CameraIntrinsics plain(CameraModel model, Resolution resolution_px) {
  CameraIntrinsics camera;
  camera.model = model;
  camera.resolution_px = resolution_px;
  camera.focal_length_px.setConstant(0.8 * std::max(resolution_px.width_px, resolution_px.height_px));
  camera.principal_point_px = 0.5 * Eigen::Vector2d(resolution_px.width_px - 1, resolution_px.height_px - 1);
  return camera;
}

std::optional<CameraIntrinsics> byOpenCv(const std::vector<SensorView>& views, Resolution resolution_px) {
  constexpr std::size_t kMostViews = 30;
  const std::size_t every = views.size() / kMostViews + 1;
  std::vector<std::vector<cv::Point3f>> on_board;
  std::vector<std::vector<cv::Point2f>> pixels;
  for (std::size_t v = 0; v < views.size(); v += every) {
    auto& points = on_board.emplace_back();
    auto& images = pixels.emplace_back();
    for (const SensorCircle& circle : views[v].circles) {
      points.emplace_back(static_cast<float>(circle.on_board_m.x()),
                          static_cast<float>(circle.on_board_m.y()), 0.0f);
      images.emplace_back(static_cast<float>(circle.centre_px.x()), static_cast<float>(circle.centre_px.y()));
    }
  }
  try {
    cv::Mat matrix, distortion;
    std::vector<cv::Mat> rotations, translations;
    cv::calibrateCamera(on_board, pixels, {resolution_px.width_px, resolution_px.height_px}, matrix,
                        distortion, rotations, translations, cv::CALIB_ZERO_TANGENT_DIST | cv::CALIB_FIX_K3);
    CameraIntrinsics camera = plain(CameraModel::PinholeRadtan, resolution_px);
    camera.focal_length_px = {matrix.at<double>(0, 0), matrix.at<double>(1, 1)};
    camera.principal_point_px = {matrix.at<double>(0, 2), matrix.at<double>(1, 2)};
    camera.distortion = {distortion.at<double>(0), distortion.at<double>(1), 0.0, 0.0, 0.0};
    const bool sane = camera.focal_length_px.allFinite() && camera.focal_length_px.minCoeff() > 1.0;
    return sane ? std::optional(camera) : std::nullopt;
  } catch (const cv::Exception&) {
    return std::nullopt;  // views that make no camera; the other starts remain
  }
}

}  // namespace

CameraIntrinsics sameLens(const CameraIntrinsics& camera, CameraModel model) {
  if (camera.model == model) return camera;
  constexpr int kColumns = 24, kRows = 18, kIterations = 15;
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> pixels_and_rays;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const Eigen::Vector2d pixel((column + 0.5) * camera.resolution_px.width_px / kColumns,
                                  (row + 0.5) * camera.resolution_px.height_px / kRows);
      if (const auto ray = unproject(camera, pixel)) pixels_and_rays.emplace_back(pixel, *ray);
    }
  }
  CameraIntrinsics same = plain(model, camera.resolution_px);
  same.focal_length_px = camera.focal_length_px;
  same.principal_point_px = camera.principal_point_px;
  const CameraIntrinsics start = same;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    if (!fitStep(pixels_and_rays, same)) return start;
  }
  return same;
}

std::vector<CameraIntrinsics> intrinsicsStarts(const std::vector<SensorView>& views, CameraModel model,
                                               Resolution resolution_px,
                                               const std::optional<CameraIntrinsics>& seen_with) {
  std::vector<CameraIntrinsics> starts;
  if (seen_with) starts.push_back(sameLens(*seen_with, model));
  // A plain lens is a guess, which may lead elsewhere.
  const bool guessed = !seen_with || seen_with->distortion == CameraIntrinsics{}.distortion;
  const auto camera = guessed ? byOpenCv(views, resolution_px) : std::nullopt;
  if (camera) starts.push_back(sameLens(*camera, model));
  if (starts.empty()) starts.push_back(plain(model, resolution_px));
  return starts;
}

}  // namespace evical
