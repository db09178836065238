#include "core/geometry/pinhole_distortion.h"

#include <cmath>

namespace evical {

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
