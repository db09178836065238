// Distortion of (x/z, y/z) for pinhole cameras; OpenCV's equations (docs/maths.md, 3.1).
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include <array>
#include <optional>

namespace evical {

using DistortionJacobian = Eigen::Matrix<double, 2, 5>;  // by the coefficients

// k1 k2 p1 p2 k3.
Eigen::Vector2d distortRadtan(const std::array<double, 5>& coefficients, const Eigen::Vector2d& normalised,
                              Eigen::Matrix2d* jacobian, DistortionJacobian* by_coefficients);

// k1 k2 k3 k4.
Eigen::Vector2d distortEquidistant(const std::array<double, 5>& coefficients,
                                   const Eigen::Vector2d& normalised, Eigen::Matrix2d* jacobian,
                                   DistortionJacobian* by_coefficients);

// Beyond the radius where a distortion folds back, points would move inwards again.
inline bool foldsBack(const Eigen::Matrix2d& jacobian) {
  return !(jacobian.determinant() > 0.0) || jacobian.trace() <= 0.0;
}

// The point whose distortion is `target`, by Newton's iteration from `start`; empty if it does not converge.
// `distort`: (normalised, &jacobian) -> distorted.
template <class Distort>
std::optional<Eigen::Vector2d> undistorted(const Eigen::Vector2d& target, const Eigen::Vector2d& start,
                                           Distort&& distort) {
  constexpr int kIterations = 30;
  Eigen::Vector2d n = start;
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Matrix2d jacobian;
    const Eigen::Vector2d error = distort(n, &jacobian) - target;
    if (!(jacobian.determinant() > 0.0)) return std::nullopt;
    Eigen::Vector2d step = jacobian.inverse() * error;
    const double longest = 0.5 * (1.0 + n.norm());
    if (step.norm() > longest) step *= longest / step.norm();
    n -= step;
    if (!n.allFinite()) return std::nullopt;
    if (step.norm() < 1e-12 * (1.0 + n.norm())) return n;
  }
  return std::nullopt;
}

}  // namespace evical
