#include "core/geometry/camera_model.h"

#include "core/base/error.h"
#include "core/geometry/undistortion_table.h"
#include "core/numerics/angles.h"

#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace evical {
namespace {

using DistortionJacobian = Eigen::Matrix<double, 2, 5>;

constexpr double kLargestAngle_rad = 85.0 * kRadPerDeg;
constexpr double kSmallRadius = 1e-8;

Eigen::Vector2d distortRadtan(const std::array<double, 5>& d, const Eigen::Vector2d& n,
                              Eigen::Matrix2d* jacobian, DistortionJacobian* jacobian_distortion) {
  const double x = n.x(), y = n.y();
  const double r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
  const double radial = 1.0 + d[0] * r2 + d[1] * r4 + d[4] * r6;
  const double p1 = d[2], p2 = d[3];
  if (jacobian) {
    const double slope = d[0] + 2.0 * d[1] * r2 + 3.0 * d[4] * r4;  // d(radial)/d(r2)
    (*jacobian)(0, 0) = radial + 2.0 * x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x;
    (*jacobian)(0, 1) = 2.0 * x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y;
    (*jacobian)(1, 0) = (*jacobian)(0, 1);
    (*jacobian)(1, 1) = radial + 2.0 * y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x;
  }
  if (jacobian_distortion) {
    *jacobian_distortion << x * r2, x * r4, 2.0 * x * y, r2 + 2.0 * x * x, x * r6,  //
        y * r2, y * r4, r2 + 2.0 * y * y, 2.0 * x * y, y * r6;
  }
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

Eigen::Vector2d distortEquidistant(const std::array<double, 5>& d, const Eigen::Vector2d& n,
                                   Eigen::Matrix2d* jacobian, DistortionJacobian* jacobian_distortion) {
  const double r = n.norm();
  if (r < kSmallRadius) {
    if (jacobian) jacobian->setIdentity();
    if (jacobian_distortion) jacobian_distortion->setZero();
    return n;
  }
  const double a = std::atan(r), a2 = a * a, a4 = a2 * a2, a6 = a4 * a2, a8 = a4 * a4;
  const double a_d = a * (1.0 + d[0] * a2 + d[1] * a4 + d[2] * a6 + d[3] * a8);
  const Eigen::Vector2d unit = n / r;
  if (jacobian) {
    const double slope =
        (1.0 + 3.0 * d[0] * a2 + 5.0 * d[1] * a4 + 7.0 * d[2] * a6 + 9.0 * d[3] * a8) / (1.0 + r * r);
    const Eigen::Matrix2d along = unit * unit.transpose();
    *jacobian = slope * along + a_d / r * (Eigen::Matrix2d::Identity() - along);
  }
  if (jacobian_distortion) {
    jacobian_distortion->col(0) = unit * (a * a2);
    jacobian_distortion->col(1) = unit * (a * a4);
    jacobian_distortion->col(2) = unit * (a * a6);
    jacobian_distortion->col(3) = unit * (a * a8);
    jacobian_distortion->col(4).setZero();
  }
  return a_d * unit;
}

Eigen::Vector2d distortWith(const CameraIntrinsics& camera, const Eigen::Vector2d& n,
                            Eigen::Matrix2d* jacobian, DistortionJacobian* jacobian_distortion) {
  return camera.model == CameraModel::PinholeRadtan
             ? distortRadtan(camera.distortion, n, jacobian, jacobian_distortion)
             : distortEquidistant(camera.distortion, n, jacobian, jacobian_distortion);
}

}  // namespace

Eigen::Vector2d distort(const CameraIntrinsics& camera, const Eigen::Vector2d& normalised,
                        Eigen::Matrix2d* jacobian) {
  return distortWith(camera, normalised, jacobian, nullptr);
}

std::optional<Eigen::Vector2d> project(const CameraIntrinsics& camera, const Eigen::Vector3d& point_in_camera,
                                       Eigen::Matrix<double, 2, 3>* jacobian_point,
                                       IntrinsicsJacobian* jacobian_intrinsics) {
  const double z = point_in_camera.z();
  if (!(z > 0.0)) return std::nullopt;
  const Eigen::Vector2d n = point_in_camera.head<2>() / z;
  Eigen::Matrix2d jacobian;
  DistortionJacobian jacobian_distortion;
  const Eigen::Vector2d distorted =
      distortWith(camera, n, &jacobian, jacobian_intrinsics ? &jacobian_distortion : nullptr);
  // Past the radius where the distortion folds back, a point would seem to come in again from outside.
  if (!(jacobian.determinant() > 0.0) || jacobian.trace() <= 0.0) return std::nullopt;
  if (jacobian_point) {
    const Eigen::Matrix2d scaled = camera.focal_length_px.asDiagonal() * jacobian / z;
    jacobian_point->leftCols<2>() = scaled;
    jacobian_point->col(2) = -scaled * n;
  }
  if (jacobian_intrinsics) {
    jacobian_intrinsics->setZero();
    (*jacobian_intrinsics)(0, 0) = distorted.x();
    (*jacobian_intrinsics)(1, 1) = distorted.y();
    jacobian_intrinsics->block<2, 2>(0, 2).setIdentity();
    jacobian_intrinsics->rightCols<5>() = camera.focal_length_px.asDiagonal() * jacobian_distortion;
  }
  return camera.focal_length_px.cwiseProduct(distorted) + camera.principal_point_px;
}

std::optional<Eigen::Vector2d> unproject(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d target = (pixel - camera.principal_point_px).cwiseQuotient(camera.focal_length_px);
  Eigen::Vector2d n = target;
  if (camera.model == CameraModel::PinholeEquidistant) {
    const double a = target.norm();
    if (a > kSmallRadius) n = target * (std::tan(std::min(a, 0.95 * kLargestAngle_rad)) / a);
  }
  constexpr int kIterations = 30;
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Matrix2d jacobian;
    const Eigen::Vector2d error = distort(camera, n, &jacobian) - target;
    if (!(jacobian.determinant() > 0.0)) return std::nullopt;
    Eigen::Vector2d step = jacobian.inverse() * error;
    const double longest = 0.5 * (1.0 + n.norm());
    if (step.norm() > longest) step *= longest / step.norm();
    n -= step;
    if (!n.allFinite()) return std::nullopt;
    if (step.norm() < 1e-12 * (1.0 + n.norm())) {
      if (std::atan(n.norm()) > kLargestAngle_rad) return std::nullopt;
      return n;
    }
  }
  return std::nullopt;
}

std::optional<Eigen::Vector2d> idealPixel(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel) {
  const std::optional<Eigen::Vector2d> n = unproject(camera, pixel);
  if (!n) return std::nullopt;
  return camera.focal_length_px.cwiseProduct(*n) + camera.principal_point_px;
}

Eigen::Vector2d pixelFromIdeal(const CameraIntrinsics& camera, const Eigen::Vector2d& ideal_pixel) {
  const Eigen::Vector2d n = (ideal_pixel - camera.principal_point_px).cwiseQuotient(camera.focal_length_px);
  return camera.focal_length_px.cwiseProduct(distort(camera, n)) + camera.principal_point_px;
}

Eigen::Matrix2d idealPixelScale(const CameraIntrinsics& camera, const Eigen::Vector2d& ideal_pixel) {
  const Eigen::Vector2d n = (ideal_pixel - camera.principal_point_px).cwiseQuotient(camera.focal_length_px);
  Eigen::Matrix2d jacobian;
  distort(camera, n, &jacobian);
  const Eigen::Matrix2d pixel_from_ideal =
      camera.focal_length_px.asDiagonal() * jacobian * camera.focal_length_px.cwiseInverse().asDiagonal();
  return pixel_from_ideal.inverse();
}

UndistortionTable::UndistortionTable(const CameraIntrinsics& camera)
    : width_px_(camera.resolution_px.width_px) {
  constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();
  ideal_px_.reserve(static_cast<std::size_t>(camera.resolution_px.pixelCount()));
  for (int y = 0; y < camera.resolution_px.height_px; ++y) {
    for (int x = 0; x < camera.resolution_px.width_px; ++x) {
      const std::optional<Eigen::Vector2d> ideal = idealPixel(camera, Eigen::Vector2d(x, y));
      ideal_px_.push_back(ideal ? Eigen::Vector2f(ideal->cast<float>())
                                : Eigen::Vector2f(kNowhere, kNowhere));
    }
  }
}

void validate(const CameraIntrinsics& camera, const std::string& place) {
  if (!camera.resolution_px.known()) {
    throw badInput(place, "resolution_px is missing or not positive", "Give [width, height] in pixels");
  }
  if (!(camera.focal_length_px.minCoeff() > 0.0) || !camera.focal_length_px.allFinite()) {
    throw badInput(place, "focal_length_px must be two numbers greater than 0");
  }
  if (!camera.principal_point_px.allFinite()) throw badInput(place, "principal_point_px must be two numbers");
  for (const double d : camera.distortion) {
    if (!std::isfinite(d)) throw badInput(place, "distortion holds something that is not a number");
  }
}

}  // namespace evical
