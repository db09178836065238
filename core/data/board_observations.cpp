#include "core/data/board_observations.h"

#include <Eigen/Eigenvalues>

namespace evical {

std::optional<Eigen::Vector2d> onlyKnownDirection(const Eigen::Matrix2d& covariance_px2) {
  constexpr double kUnknown_px = 2.0, kRatio = 10.0;  // of sigmas
  const double half_trace = 0.5 * covariance_px2.trace();
  if (half_trace < 0.5 * kUnknown_px * kUnknown_px) return std::nullopt;  // most points
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance_px2);
  const Eigen::Vector2d& variances = axes.eigenvalues();
  if (variances.y() < kUnknown_px * kUnknown_px || variances.y() < kRatio * kRatio * variances.x())
    return std::nullopt;
  return Eigen::Vector2d(axes.eigenvectors().col(0));
}

const char* windowOutcomeName(WindowOutcome outcome) {
  static constexpr std::array<const char*, kWindowOutcomeCount> kNames = {"complete",
                                                                          "partial",
                                                                          "too few events",
                                                                          "too few candidates",
                                                                          "no lattice",
                                                                          "too few points in the lattice",
                                                                          "ambiguous placement",
                                                                          "points lost in refinement",
                                                                          "too blurred",
                                                                          "unreadable",
                                                                          "rejected by hand",
                                                                          "too small in the image",
                                                                          "other tags between the corners"};
  return kNames[static_cast<std::size_t>(outcome)];
}

}  // namespace evical
