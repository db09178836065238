#include "core/geometry/sphere_lens.h"

#include <Eigen/Geometry>

#include <cmath>

namespace evical {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Row = Eigen::RowVector3d;

// (x, y) / value, with the derivatives of the value: two coefficients at most.
struct Depth {
  double value;
  Row by_point;
  std::array<double, 2> by_coefficients;
  bool seen;
};

// z / d at which x / (alpha d + (1 - alpha) z) has its maximum.
double lowestCosine(double alpha) {
  return alpha > 0.5 ? -(1.0 - alpha) / alpha : -alpha / (1.0 - alpha);
}

Depth doubleSphereDepth(const CameraIntrinsics& camera, const Vector3d& p) {
  const double xi = camera.distortion[0], alpha = camera.distortion[1];
  const double d1 = p.norm();
  const double z2 = xi * d1 + p.z();  // from the second sphere's centre
  const double d2 = std::hypot(p.x(), p.y(), z2);
  const Row z2_by_point = xi / d1 * p.transpose() + Row::UnitZ();
  const Row d2_by_point = Row(p.x(), p.y(), 0.0) / d2 + z2 / d2 * z2_by_point;
  Depth depth;
  depth.value = alpha * d2 + (1.0 - alpha) * z2;
  depth.by_point = alpha * d2_by_point + (1.0 - alpha) * z2_by_point;
  depth.by_coefficients = {alpha * z2 / d2 * d1 + (1.0 - alpha) * d1, d2 - z2};
  depth.seen = z2 > lowestCosine(alpha) * d2;
  return depth;
}

Depth eucmDepth(const CameraIntrinsics& camera, const Vector3d& p) {
  const double alpha = camera.distortion[0], beta = camera.distortion[1];
  const double rho2 = p.head<2>().squaredNorm();
  const double d = std::sqrt(beta * rho2 + p.z() * p.z());
  Depth depth;
  depth.value = alpha * d + (1.0 - alpha) * p.z();
  depth.by_point = alpha / d * Row(beta * p.x(), beta * p.y(), p.z()) + (1.0 - alpha) * Row::UnitZ();
  depth.by_coefficients = {d - p.z(), 0.5 * alpha * rho2 / d};
  depth.seen = p.z() > lowestCosine(alpha) * d;
  return depth;
}

Depth unifiedDepth(const CameraIntrinsics& camera, const Vector3d& p) {
  const double xi = camera.distortion[0];
  const double d1 = p.norm();
  Depth depth;
  depth.value = xi * d1 + p.z();
  depth.by_point = xi / d1 * p.transpose() + Row::UnitZ();
  depth.by_coefficients = {d1, 0.0};
  depth.seen = depth.value > 0.0 && d1 + xi * p.z() > 0.0;
  return depth;
}

SphereImage divided(const Vector3d& p, const Depth& depth) {
  SphereImage out;
  out.image = p.head<2>() / depth.value;
  out.by_point = -out.image * depth.by_point / depth.value;
  out.by_point.leftCols<2>().diagonal().array() += 1.0 / depth.value;
  out.by_coefficients.setZero();
  for (Eigen::Index k = 0; k < 2; ++k)
    out.by_coefficients.col(k) =
        -out.image * (depth.by_coefficients[static_cast<std::size_t>(k)] / depth.value);
  out.seen = depth.seen && depth.value > 0.0;
  return out;
}

// k1 k2 p1 p2, after xi.
std::array<double, 5> radtanOf(const CameraIntrinsics& omni) {
  const auto& d = omni.distortion;
  return {d[1], d[2], d[3], d[4], 0.0};
}

SphereImage omniImage(const CameraIntrinsics& camera, const Vector3d& p) {
  SphereImage out = divided(p, unifiedDepth(camera, p));
  Eigen::Matrix2d by_image;
  DistortionJacobian by_radtan;
  out.image = distortRadtan(radtanOf(camera), out.image, &by_image, &by_radtan);
  out.by_point = (by_image * out.by_point).eval();
  out.by_coefficients.col(0) = (by_image * out.by_coefficients.col(0)).eval();
  out.by_coefficients.rightCols<4>() = by_radtan.leftCols<4>();
  out.seen = out.seen && !foldsBack(by_image);
  return out;
}

// z of the direction (m, z) whose image x / (alpha d + (1 - alpha) z) is m; d^2 = beta rho^2 + z^2.
std::optional<double> unifiedZ(double alpha, double beta, double m2) {
  const double root2 = 1.0 - (2.0 * alpha - 1.0) * beta * m2;
  if (!(root2 >= 0.0)) return std::nullopt;
  const double divisor = alpha * std::sqrt(root2) + 1.0 - alpha;
  if (!(divisor > 0.0)) return std::nullopt;
  return (1.0 - beta * alpha * alpha * m2) / divisor;
}

// Converts a direction from a point xi behind the unit sphere's centre to the direction from the centre.
std::optional<Vector3d> fromSphere(double xi, const Vector2d& m, double z) {
  const double m2 = m.squaredNorm();
  const double root2 = z * z + (1.0 - xi * xi) * m2;
  if (!(root2 >= 0.0)) return std::nullopt;
  const double length = (z * xi + std::sqrt(root2)) / (z * z + m2);
  return Vector3d(length * m.x(), length * m.y(), length * z - xi).normalized();
}

std::optional<Vector3d> omniRay(const CameraIntrinsics& camera, const Vector2d& image) {
  const std::array<double, 5> radtan = radtanOf(camera);
  const auto m = undistorted(image, image, [&](const Vector2d& n, Eigen::Matrix2d* jacobian) {
    return distortRadtan(radtan, n, jacobian, nullptr);
  });
  return m ? fromSphere(camera.distortion[0], *m, 1.0) : std::nullopt;
}

}  // namespace

SphereImage sphereImage(const CameraIntrinsics& camera, const Vector3d& p) {
  if (camera.model == CameraModel::DoubleSphere) return divided(p, doubleSphereDepth(camera, p));
  if (camera.model == CameraModel::Eucm) return divided(p, eucmDepth(camera, p));
  return omniImage(camera, p);
}

std::optional<Vector3d> sphereRay(const CameraIntrinsics& camera, const Vector2d& image) {
  if (camera.model == CameraModel::OmniRadtan) return omniRay(camera, image);
  const double m2 = image.squaredNorm();
  if (camera.model == CameraModel::Eucm) {
    const auto z = unifiedZ(camera.distortion[0], camera.distortion[1], m2);
    return z ? std::optional(Vector3d(image.x(), image.y(), *z).normalized()) : std::nullopt;
  }
  const auto z = unifiedZ(camera.distortion[1], 1.0, m2);
  return z ? fromSphere(camera.distortion[0], image, *z) : std::nullopt;
}

}  // namespace evical
