#include "core/geometry/camera_model.h"

#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/sphere_lens.h"

#include "core/base/error.h"
#include "core/numerics/angles.h"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace evical {
namespace {

constexpr double kLargestAngle_rad = 85.0 * kRadPerDeg;
constexpr double kCentralAngle_rad = 1e-8;

Eigen::Vector2d distortPinhole(const CameraIntrinsics& camera, const Eigen::Vector2d& n,
                               Eigen::Matrix2d* jacobian, DistortionJacobian* jacobian_distortion) {
  return camera.model == CameraModel::PinholeRadtan
             ? distortRadtan(camera.distortion, n, jacobian, jacobian_distortion)
             : distortEquidistant(camera.distortion, n, jacobian, jacobian_distortion);
}

// Like project, with focal length 1 and principal point 0.
std::optional<Eigen::Vector2d> pinholeImage(const CameraIntrinsics& camera, const Eigen::Vector3d& point,
                                            Eigen::Matrix<double, 2, 3>* by_point,
                                            DistortionJacobian* by_coefficients) {
  const double z = point.z();
  if (!(z > 0.0)) return std::nullopt;
  const Eigen::Vector2d n = point.head<2>() / z;
  Eigen::Matrix2d jacobian;
  const Eigen::Vector2d distorted = distortPinhole(camera, n, &jacobian, by_coefficients);
  if (foldsBack(jacobian)) return std::nullopt;
  if (by_point) {
    by_point->leftCols<2>() = jacobian / z;
    by_point->col(2) = -jacobian * n / z;
  }
  return distorted;
}

std::optional<Eigen::Vector2d> imageOf(const CameraIntrinsics& camera, const Eigen::Vector3d& point,
                                       Eigen::Matrix<double, 2, 3>* by_point,
                                       DistortionJacobian* by_coefficients) {
  if (!isSphereModel(camera.model)) return pinholeImage(camera, point, by_point, by_coefficients);
  const SphereImage image = sphereImage(camera, point);
  if (!image.seen) return std::nullopt;
  if (by_point) *by_point = image.by_point;
  if (by_coefficients) *by_coefficients = image.by_coefficients;
  return image.image;
}

std::optional<Eigen::Vector2d> unprojectPinhole(const CameraIntrinsics& camera,
                                                const Eigen::Vector2d& target) {
  Eigen::Vector2d start = target;
  if (camera.model == CameraModel::PinholeEquidistant) {
    const double a = target.norm();
    if (a > kCentralAngle_rad) start = target * (std::tan(std::min(a, 0.95 * kLargestAngle_rad)) / a);
  }
  return undistorted(target, start, [&](const Eigen::Vector2d& n, Eigen::Matrix2d* jacobian) {
    return distortPinhole(camera, n, jacobian, nullptr);
  });
}

Eigen::Vector2d imageAt(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel) {
  return (pixel - camera.principal_point_px).cwiseQuotient(camera.focal_length_px);
}

// (x/z, y/z) of an ideal pixel.
Eigen::Vector2d normalisedAt(const CameraIntrinsics& camera, const Eigen::Vector2d& ideal_pixel) {
  return (ideal_pixel - camera.principal_point_px).cwiseQuotient(idealFocalLength_px(camera));
}

// x and y are exchanged: the principal point is far from the image's centre, and would be near it in the
// other order.
bool hasExchangedPrincipalPoint(const CameraIntrinsics& camera) {
  constexpr double kFar = 0.1, kNear = 0.25;  // of the image's longer side; of the distance as given
  const Eigen::Vector2d size_px(camera.resolution_px.width_px, camera.resolution_px.height_px);
  const Eigen::Vector2d& given_px = camera.principal_point_px;
  const double distance_px = (given_px - 0.5 * size_px).norm();
  return distance_px > kFar * size_px.maxCoeff() &&
         (given_px.reverse() - 0.5 * size_px).norm() < kNear * distance_px;
}

}  // namespace

Eigen::Vector2d distort(const CameraIntrinsics& camera, const Eigen::Vector2d& normalised,
                        Eigen::Matrix2d* jacobian) {
  if (!isSphereModel(camera.model)) return distortPinhole(camera, normalised, jacobian, nullptr);
  const SphereImage image = sphereImage(camera, normalised.homogeneous());
  if (jacobian) *jacobian = image.by_point.leftCols<2>();
  return image.image;
}

std::optional<Eigen::Vector2d> project(const CameraIntrinsics& camera, const Eigen::Vector3d& point_in_camera,
                                       Eigen::Matrix<double, 2, 3>* jacobian_point,
                                       IntrinsicsJacobian* jacobian_intrinsics) {
  DistortionJacobian by_coefficients;
  const auto image =
      imageOf(camera, point_in_camera, jacobian_point, jacobian_intrinsics ? &by_coefficients : nullptr);
  if (!image) return std::nullopt;
  if (jacobian_point) *jacobian_point = (camera.focal_length_px.asDiagonal() * *jacobian_point).eval();
  if (jacobian_intrinsics) {
    jacobian_intrinsics->setZero();
    (*jacobian_intrinsics)(0, 0) = image->x();
    (*jacobian_intrinsics)(1, 1) = image->y();
    jacobian_intrinsics->block<2, 2>(0, 2).setIdentity();
    jacobian_intrinsics->rightCols<5>() = camera.focal_length_px.asDiagonal() * by_coefficients;
  }
  return camera.focal_length_px.cwiseProduct(*image) + camera.principal_point_px;
}

std::optional<Eigen::Vector2d> unproject(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d image = imageAt(camera, pixel);
  if (isSphereModel(camera.model)) {
    const auto ray = sphereRay(camera, image);
    const bool near_axis = ray && ray->z() > std::cos(kLargestAngle_rad);
    return near_axis ? std::optional(Eigen::Vector2d(ray->head<2>() / ray->z())) : std::nullopt;
  }
  const auto n = unprojectPinhole(camera, image);
  return n && std::atan(n->norm()) <= kLargestAngle_rad ? n : std::nullopt;
}

std::optional<Eigen::Vector3d> unprojectRay(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel) {
  if (isSphereModel(camera.model)) return sphereRay(camera, imageAt(camera, pixel));
  const auto n = unproject(camera, pixel);
  return n ? std::optional(Eigen::Vector3d(n->homogeneous().normalized())) : std::nullopt;
}

Eigen::Vector2d idealFocalLength_px(const CameraIntrinsics& camera) {
  return hasCentresApart(camera.model)
             ? Eigen::Vector2d(camera.focal_length_px / (1.0 + camera.distortion[0]))
             : camera.focal_length_px;
}

std::optional<Eigen::Vector2d> idealPixel(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel) {
  const std::optional<Eigen::Vector2d> n = unproject(camera, pixel);
  if (!n) return std::nullopt;
  return idealFocalLength_px(camera).cwiseProduct(*n) + camera.principal_point_px;
}

Eigen::Vector2d pixelFromIdeal(const CameraIntrinsics& camera, const Eigen::Vector2d& ideal_pixel) {
  const Eigen::Vector2d n = normalisedAt(camera, ideal_pixel);
  return camera.focal_length_px.cwiseProduct(distort(camera, n)) + camera.principal_point_px;
}

Eigen::Matrix2d idealPixelScale(const CameraIntrinsics& camera, const Eigen::Vector2d& ideal_pixel) {
  Eigen::Matrix2d jacobian;
  distort(camera, normalisedAt(camera, ideal_pixel), &jacobian);
  const Eigen::Matrix2d pixel_from_ideal = camera.focal_length_px.asDiagonal() * jacobian *
                                           idealFocalLength_px(camera).cwiseInverse().asDiagonal();
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
  if (hasExchangedPrincipalPoint(camera))
    throw badInput(
        place,
        fmt::format("the principal point ({:.1f}, {:.1f}) seems to have x and y exchanged, since the "
                    "image has {} x {} px",
                    camera.principal_point_px.x(), camera.principal_point_px.y(),
                    camera.resolution_px.width_px, camera.resolution_px.height_px),
        "Give x, along the image's width, first");
  for (const double d : camera.distortion) {
    if (!std::isfinite(d)) throw badInput(place, "distortion contains a value that is not a finite number");
  }
  const IntrinsicsBounds bounds = intrinsicsBounds(camera.model);
  const auto names = distortionNames(camera.model);
  for (std::size_t k = 0; k < camera.distortion.size(); ++k) {
    const double lower = bounds.lower[4 + k], upper = bounds.upper[4 + k];
    if (camera.distortion[k] < lower || camera.distortion[k] > upper)
      throw badInput(place,
                     fmt::format("{} is {}, but {} needs a value from {} to {}", names[k],
                                 camera.distortion[k], cameraModelName(camera.model), lower, upper),
                     "Check the model, and the order of its coefficients");
  }
}

const CameraIntrinsics& normalisedCamera() {
  static const CameraIntrinsics camera{
      CameraModel::PinholeRadtan, {1, 1}, Eigen::Vector2d::Ones(), Eigen::Vector2d::Zero(), {}};
  return camera;
}

constexpr double kCentralRadius = 1e-8;

Eigen::Vector2d distortRadtan(const std::array<double, 5>& d, const Eigen::Vector2d& n,
                              Eigen::Matrix2d* jacobian, DistortionJacobian* by_coefficients) {
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
  if (by_coefficients) {
    *by_coefficients << x * r2, x * r4, 2.0 * x * y, r2 + 2.0 * x * x, x * r6,  //
        y * r2, y * r4, r2 + 2.0 * y * y, 2.0 * x * y, y * r6;
  }
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

Eigen::Vector2d distortEquidistant(const std::array<double, 5>& d, const Eigen::Vector2d& n,
                                   Eigen::Matrix2d* jacobian, DistortionJacobian* by_coefficients) {
  const double r = n.norm();
  if (r < kCentralRadius) {
    if (jacobian) jacobian->setIdentity();
    if (by_coefficients) by_coefficients->setZero();
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
  if (by_coefficients) {
    by_coefficients->col(0) = unit * (a * a2);
    by_coefficients->col(1) = unit * (a * a4);
    by_coefficients->col(2) = unit * (a * a6);
    by_coefficients->col(3) = unit * (a * a8);
    by_coefficients->col(4).setZero();
  }
  return a_d * unit;
}

}  // namespace evical
