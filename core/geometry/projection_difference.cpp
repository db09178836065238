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
  Eigen::Matrix<double, 2, 3> by_turn;  // with respect to a rotation of the camera
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

namespace {

// Errors of `other` along the rays, after the rotation that fits them best.
std::vector<std::optional<Eigen::Vector2d>> turnedErrors(const std::vector<std::optional<RayPixel>>& rays,
                                                         const CameraIntrinsics& other) {
  constexpr int kIterations = 5, kMinRays = 3;
  std::vector<std::optional<Eigen::Vector2d>> errors;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  for (int iteration = 0; iteration <= kIterations; ++iteration) {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    Eigen::Vector3d vector = Eigen::Vector3d::Zero();
    errors.assign(rays.size(), std::nullopt);
    int seen = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto projected = rays[i] ? project(other, turn * rays[i]->ray) : std::nullopt;
      if (!projected) continue;
      errors[i] = *projected - rays[i]->pixel;
      matrix += rays[i]->by_turn.transpose() * rays[i]->by_turn;
      vector -= rays[i]->by_turn.transpose() * *errors[i];
      ++seen;
    }
    if (seen < kMinRays) return errors;
    if (iteration < kIterations) turn = so3Exp(matrix.ldlt().solve(vector)) * turn;
  }
  return errors;
}

}  // namespace

std::vector<std::optional<Eigen::Vector2d>> projectionDifferences(const CameraIntrinsics& camera,
                                                                  const CameraIntrinsics& other, int columns,
                                                                  int rows) {
  std::vector<std::optional<RayPixel>> rays;
  for (const Eigen::Vector2d& pixel : cellMiddles(camera.resolution_px, columns, rows))
    rays.push_back(rayPixel(camera, pixel));
  return turnedErrors(rays, other);
}

ProjectionDifference projectionDifference(const CameraIntrinsics& camera, const CameraIntrinsics& other,
                                          double radius_share) {
  constexpr int kColumns = 32, kRows = 24;
  const Eigen::Vector2d size(camera.resolution_px.width_px, camera.resolution_px.height_px);
  const Eigen::Vector2d furthest = camera.principal_point_px.cwiseMax(size - camera.principal_point_px);
  std::vector<std::optional<RayPixel>> rays;
  for (const Eigen::Vector2d& pixel : cellMiddles(camera.resolution_px, kColumns, kRows)) {
    if ((pixel - camera.principal_point_px).norm() > radius_share * furthest.norm()) continue;
    rays.push_back(rayPixel(camera, pixel));
  }
  ProjectionDifference difference;
  for (const std::optional<Eigen::Vector2d>& error_px : turnedErrors(rays, other)) {
    if (!error_px) continue;
    difference.rms_px += error_px->squaredNorm();
    difference.max_px = std::max(difference.max_px, error_px->norm());
    ++difference.places;
  }
  if (difference.places > 0) difference.rms_px = std::sqrt(difference.rms_px / difference.places);
  return difference;
}

}  // namespace evical
