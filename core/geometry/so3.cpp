#include "core/geometry/so3.h"

#include <cmath>

namespace evical {
namespace {

constexpr double kSmallAngle2 = 1e-8;  // rad^2; below it the series is exact to double precision

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Matrix3d so3Exp(const Eigen::Vector3d& rotation_vector_rad) {
  const double angle2 = rotation_vector_rad.squaredNorm();
  double a, b;  // sin(x)/x, (1-cos(x))/x^2
  if (angle2 < kSmallAngle2) {
    a = 1.0 - angle2 / 6.0;
    b = 0.5 - angle2 / 24.0;
  } else {
    const double angle = std::sqrt(angle2);
    a = std::sin(angle) / angle;
    b = (1.0 - std::cos(angle)) / angle2;
  }
  const Eigen::Matrix3d k = skew(rotation_vector_rad);
  return Eigen::Matrix3d::Identity() + a * k + b * k * k;
}

Eigen::Quaterniond quaternionExp(const Eigen::Vector3d& rotation_vector_rad) {
  const double angle2 = rotation_vector_rad.squaredNorm();
  double s, c;  // sin(x/2)/x, cos(x/2)
  if (angle2 < kSmallAngle2) {
    s = 0.5 - angle2 / 48.0;
    c = 1.0 - angle2 / 8.0;
  } else {
    const double angle = std::sqrt(angle2);
    s = std::sin(0.5 * angle) / angle;
    c = std::cos(0.5 * angle);
  }
  return {c, s * rotation_vector_rad.x(), s * rotation_vector_rad.y(), s * rotation_vector_rad.z()};
}

Eigen::Vector3d quaternionLog(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d v = sign * rotation.vec();
  const double w = sign * rotation.w();
  const double n = v.norm();
  if (n < 1e-7) return (2.0 / w - 2.0 / 3.0 * n * n / (w * w * w)) * v;
  return 2.0 * std::atan2(n, w) / n * v;
}

Eigen::Vector3d so3Log(const Eigen::Matrix3d& rotation) {
  return quaternionLog(Eigen::Quaterniond(rotation));
}

Eigen::Matrix3d so3RightJacobian(const Eigen::Vector3d& rotation_vector_rad) {
  const double angle2 = rotation_vector_rad.squaredNorm();
  double b, c;  // (1-cos x)/x^2, (x-sin x)/x^3
  if (angle2 < 1e-6) {
    b = 0.5 - angle2 / 24.0;
    c = 1.0 / 6.0 - angle2 / 120.0;
  } else {
    const double angle = std::sqrt(angle2);
    b = (1.0 - std::cos(angle)) / angle2;
    c = (angle - std::sin(angle)) / (angle2 * angle);
  }
  const Eigen::Matrix3d k = skew(rotation_vector_rad);
  return Eigen::Matrix3d::Identity() - b * k + c * k * k;
}

Eigen::Matrix3d so3RightJacobianInverse(const Eigen::Vector3d& rotation_vector_rad) {
  const double angle2 = rotation_vector_rad.squaredNorm();
  double c;  // 1/x^2 - (1+cos x)/(2 x sin x) = 1/x^2 - cot(x/2)/(2x)
  if (angle2 < 1e-6) {
    c = 1.0 / 12.0 + angle2 / 720.0;
  } else {
    const double angle = std::sqrt(angle2);
    c = 1.0 / angle2 - std::cos(0.5 * angle) / (2.0 * angle * std::sin(0.5 * angle));
  }
  const Eigen::Matrix3d k = skew(rotation_vector_rad);
  return Eigen::Matrix3d::Identity() + 0.5 * k + c * k * k;
}

}  // namespace evical
