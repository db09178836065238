#include "core/geometry/projection_difference.h"

#include "core/geometry/so3.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

struct RayPixel {
  Eigen::Vector2d pixel;
  Eigen::Vector3d ray;                  // unit
  Eigen::Matrix<double, 2, 3> by_turn;  // of the camera that looks along it
};

std::optional<RayPixel> rayPixel(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel) {
  const auto ray = unprojectRay(camera, pixel);
  if (!ray) return std::nullopt;
  RayPixel out{pixel, *ray, {}};
  Eigen::Matrix<double, 2, 3> by_point;
  if (!project(camera, out.ray, &by_point)) return std::nullopt;
  out.by_turn = -by_point * skew(out.ray);
  return out;
}

std::vector<Eigen::Vector2d> cellMiddles(Resolution size, int columns, int rows) {
  std::vector<Eigen::Vector2d> pixels;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      pixels.emplace_back((column + 0.5) * size.width_px / columns - 0.5,
                          (row + 0.5) * size.height_px / rows - 0.5);
  return pixels;
}

}  // namespace

ProjectionChange::ProjectionChange(const CameraIntrinsics& camera, int columns, int rows) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 9> vector = Eigen::Matrix<double, 3, 9>::Zero();
  std::vector<std::optional<RayPixel>> rays;
  for (const Eigen::Vector2d& pixel : cellMiddles(camera.resolution_px, columns, rows)) {
    Place& place = places_.emplace_back();
    place.pixel = pixel;
    rays.push_back(rayPixel(camera, pixel));
    if (!rays.back()) continue;
    IntrinsicsJacobian jacobian;
    if (!project(camera, rays.back()->ray, nullptr, &jacobian)) continue;
    place.by_intrinsics = jacobian;
    matrix += rays.back()->by_turn.transpose() * rays.back()->by_turn;
    vector += rays.back()->by_turn.transpose() * jacobian;
  }
  const Eigen::Matrix<double, 3, 9> turn = matrix.ldlt().solve(vector);
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (places_[i].by_intrinsics) *places_[i].by_intrinsics -= rays[i]->by_turn * turn;
}

ProjectionDifference projectionDifference(const CameraIntrinsics& camera, const CameraIntrinsics& other,
                                          double radius_share) {
  constexpr int kColumns = 32, kRows = 24, kIterations = 5;
  const Eigen::Vector2d size(camera.resolution_px.width_px, camera.resolution_px.height_px);
  const Eigen::Vector2d furthest = camera.principal_point_px.cwiseMax(size - camera.principal_point_px);
  std::vector<RayPixel> rays;
  for (const Eigen::Vector2d& pixel : cellMiddles(camera.resolution_px, kColumns, kRows)) {
    if ((pixel - camera.principal_point_px).norm() > radius_share * furthest.norm()) continue;
    if (const auto ray = rayPixel(camera, pixel)) rays.push_back(*ray);
  }
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  ProjectionDifference difference;
  for (int iteration = 0; iteration <= kIterations; ++iteration) {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    Eigen::Vector3d vector = Eigen::Vector3d::Zero();
    difference = {};
    for (const RayPixel& ray : rays) {
      const auto projected = project(other, turn * ray.ray);
      if (!projected) continue;
      const Eigen::Vector2d error = *projected - ray.pixel;
      matrix += ray.by_turn.transpose() * ray.by_turn;
      vector -= ray.by_turn.transpose() * error;
      difference.rms_px += error.squaredNorm();
      difference.max_px = std::max(difference.max_px, error.norm());
      ++difference.places;
    }
    if (difference.places < 3) return difference;
    difference.rms_px = std::sqrt(difference.rms_px / difference.places);
    if (iteration < kIterations) turn = so3Exp(matrix.ldlt().solve(vector)) * turn;
  }
  return difference;
}

}  // namespace evical
