#include "core/geometry/so3.h"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <cmath>

namespace evical {
namespace {

// Below this, the series of sine and cosine with two terms are exact in double precision.
constexpr double kSmallAngle2 = 1e-8;  // rad^2

// Weights of skew(v) and its square in Rodrigues' formula and its derivative.
struct Coefficients {
  double sine;    // sin(x)/x
  double cosine;  // (1 - cos(x))/x^2
  double cubic;   // (x - sin(x))/x^3
};

// Differences of nearly equal numbers lose digits long before they divide by zero, hence the series with four
// terms up to 0.01 rad, where the next one is below double precision.
Coefficients coefficients(double angle2) {
  if (angle2 < 1e-4)
    return {1.0 - angle2 / 6.0 * (1.0 - angle2 / 20.0 * (1.0 - angle2 / 42.0)),
            0.5 - angle2 / 24.0 * (1.0 - angle2 / 30.0 * (1.0 - angle2 / 56.0)),
            1.0 / 6.0 - angle2 / 120.0 * (1.0 - angle2 / 42.0 * (1.0 - angle2 / 72.0))};
  const double angle = std::sqrt(angle2), sine = std::sin(angle), cosine = std::cos(angle);
  return {sine / angle, (1.0 - cosine) / angle2, (angle - sine) / (angle2 * angle)};
}

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

// Has a separate series: the one above would be equally suitable, but moves the last digits of estimates.
Eigen::Matrix3d so3Exp(const Eigen::Vector3d& rotation_vector_rad) {
  const double angle2 = rotation_vector_rad.squaredNorm();
  double sine, cosine;  // sin(x)/x, (1-cos(x))/x^2
  if (angle2 < kSmallAngle2) {
    sine = 1.0 - angle2 / 6.0;
    cosine = 0.5 - angle2 / 24.0;
  } else {
    const double angle = std::sqrt(angle2);
    sine = std::sin(angle) / angle;
    cosine = (1.0 - std::cos(angle)) / angle2;
  }
  const Eigen::Matrix3d k = skew(rotation_vector_rad);
  return Eigen::Matrix3d::Identity() + sine * k + cosine * k * k;
}

void so3ExpAndRightJacobian(const Eigen::Vector3d& rotation_vector_rad, Eigen::Matrix3d& exponential,
                            Eigen::Matrix3d& right_jacobian) {
  const double angle2 = rotation_vector_rad.squaredNorm();
  const Coefficients by = coefficients(angle2);
  const double x = rotation_vector_rad.x(), y = rotation_vector_rad.y(), z = rotation_vector_rad.z();
  Eigen::Matrix3d square;  // skew(v)^2 = v v^T - |v|^2
  square << x * x - angle2, x * y, x * z, x * y, y * y - angle2, y * z, x * z, y * z, z * z - angle2;
  const Eigen::Matrix3d k = skew(rotation_vector_rad);
  exponential = by.sine * k + by.cosine * square;
  right_jacobian = by.cubic * square - by.cosine * k;
  for (int i = 0; i < 3; ++i) {
    exponential(i, i) += 1.0;
    right_jacobian(i, i) += 1.0;
  }
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
  Eigen::Matrix3d exponential, right_jacobian;
  so3ExpAndRightJacobian(rotation_vector_rad, exponential, right_jacobian);
  return right_jacobian;
}

Eigen::Matrix3d so3RightJacobianInverse(const Eigen::Vector3d& rotation_vector_rad) {
  const double angle2 = rotation_vector_rad.squaredNorm();
  double c;  // 1/x^2 - (1+cos x)/(2 x sin x) = 1/x^2 - cot(x/2)/(2x); its last digits go with skew(v)^2
  if (angle2 < 1e-6) {
    c = 1.0 / 12.0 + angle2 / 720.0;
  } else {
    const double angle = std::sqrt(angle2);
    c = 1.0 / angle2 - std::cos(0.5 * angle) / (2.0 * angle * std::sin(0.5 * angle));
  }
  const Eigen::Matrix3d k = skew(rotation_vector_rad);
  return Eigen::Matrix3d::Identity() + 0.5 * k + c * k * k;
}

Eigen::Quaterniond rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

BestRotation bestRotation(const Eigen::Matrix3d& sum_of_products, double determinant) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum_of_products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d free = svd.matrixU() * svd.matrixV().transpose();
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if (free.determinant() * determinant < 0.0) signs[2] = -1.0;
  return {svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose(), svd.singularValues(),
          svd.matrixU().col(0)};
}

RigidTransform operator*(const RigidTransform& a_from_b, const RigidTransform& b_from_c) {
  return {(a_from_b.rotation * b_from_c.rotation).normalized(), a_from_b * b_from_c.translation_m};
}

RigidTransform inverse(const RigidTransform& a_from_b) {
  const Eigen::Quaterniond b_from_a = a_from_b.rotation.conjugate();
  return {b_from_a, -(b_from_a * a_from_b.translation_m)};
}

double rotationAngleBetween_rad(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return quaternionLog(a.conjugate() * b).norm();
}

}  // namespace evical
