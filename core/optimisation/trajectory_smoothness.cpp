#include "core/optimisation/trajectory_smoothness.h"

#include "core/geometry/so3.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace evical {
namespace {

// Derivative by delta, as So3Manifold requires.
void writeByRotation(const Eigen::Matrix3d& by_delta, double* jacobian) {
  Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> out(jacobian);
  out.leftCols<3>() = by_delta;
  out.rightCols<1>().setZero();
}

// Segments of a spline that contain a view.
std::vector<std::uint8_t> seenSegments(const CalibrationInput& input, const CalibrationState& state,
                                       double start_s, double spacing_s, int segments) {
  std::vector<std::uint8_t> seen(static_cast<std::size_t>(std::max(0, segments)));
  for (std::size_t camera = 0; camera < input.cameras.size(); ++camera) {
    for (const BoardView& view : input.cameras[camera].observations.views) {
      const double place = (referenceTime_s(state.cameras[camera], view.time_s) - start_s) / spacing_s;
      if (place >= 0.0 && place < static_cast<double>(segments)) seen[static_cast<std::size_t>(place)] = 1;
    }
  }
  return seen;
}

// acceleration(k, n): from control points k - 2 n, k - n, k, times the square of their distance in time. Used
// if all segments between contain views. The distance is so large that noise of single views hardly matters.
template <class Acceleration>
double rms(const std::vector<std::uint8_t>& seen, double spacing_s, Acceleration&& acceleration) {
  constexpr double kApart_s = 0.1;
  const auto n = static_cast<std::size_t>(std::max(1.0, std::round(kApart_s / spacing_s)));
  double squares = 0.0;
  int count = 0;
  for (std::size_t k = 2 * n + 1; k < seen.size() + 2; ++k) {
    const auto first = seen.begin() + static_cast<std::ptrdiff_t>(k - 2 * n - 1),
               last = seen.begin() + static_cast<std::ptrdiff_t>(k - 1);
    if (std::find(first, last, std::uint8_t{0}) != last) continue;
    squares += Eigen::Vector3d(acceleration(k, n)).squaredNorm();
    count += 3;
  }
  if (count == 0) return std::numeric_limits<double>::infinity();
  const double apart_s = static_cast<double>(n) * spacing_s;
  return std::sqrt(squares / count) / (apart_s * apart_s);
}

}  // namespace

SmoothRotationCost::SmoothRotationCost(double knot_spacing_s, double sigma_rad_s2)
    : weight_(1.0 / (sigma_rad_s2 * knot_spacing_s * knot_spacing_s)) {}

bool SmoothRotationCost::Evaluate(double const* const* parameters, double* residuals,
                                  double** jacobians) const {
  const Eigen::Map<const Eigen::Quaterniond> a(parameters[0]), b(parameters[1]), c(parameters[2]);
  const Eigen::Vector3d before = quaternionLog(a.conjugate() * b), after = quaternionLog(b.conjugate() * c);
  Eigen::Map<Eigen::Vector3d>{residuals} = weight_ * (after - before);
  if (!jacobians) return true;
  // d Log(A^T B) by B: inverse right Jacobian; by A: minus the inverse left one, which is its transpose.
  const Eigen::Matrix3d by_later_before = so3RightJacobianInverse(before),
                        by_later_after = so3RightJacobianInverse(after);
  if (jacobians[0]) writeByRotation(weight_ * by_later_before.transpose(), jacobians[0]);
  if (jacobians[1]) writeByRotation(-weight_ * (by_later_after.transpose() + by_later_before), jacobians[1]);
  if (jacobians[2]) writeByRotation(weight_ * by_later_after, jacobians[2]);
  return true;
}

SmoothPositionCost::SmoothPositionCost(double knot_spacing_s, double sigma_m_s2)
    : weight_(1.0 / (sigma_m_s2 * knot_spacing_s * knot_spacing_s)) {}

bool SmoothPositionCost::Evaluate(double const* const* parameters, double* residuals,
                                  double** jacobians) const {
  const Eigen::Map<const Eigen::Vector3d> a(parameters[0]), b(parameters[1]), c(parameters[2]);
  Eigen::Map<Eigen::Vector3d>{residuals} = weight_ * (a - 2.0 * b + c);
  if (!jacobians) return true;
  constexpr double kWeights[] = {1.0, -2.0, 1.0};
  for (int k = 0; k < 3; ++k) {
    if (!jacobians[k]) continue;
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{jacobians[k]} =
        weight_ * kWeights[k] * Eigen::Matrix3d::Identity();
  }
  return true;
}

TrajectorySmoothness trajectorySmoothness(const CalibrationInput& input, const CalibrationState& state) {
  const So3Spline& r = state.world_from_imu_rotation;
  const VectorSpline& p = state.imu_in_world_m;
  TrajectorySmoothness found;
  found.rotation_rad_s2 =
      rms(seenSegments(input, state, r.start_s, r.knot_spacing_s, r.segmentCount()), r.knot_spacing_s,
          [&](std::size_t k, std::size_t n) -> Eigen::Vector3d {
            return quaternionLog(r.control_points[k - n].conjugate() * r.control_points[k]) -
                   quaternionLog(r.control_points[k - 2 * n].conjugate() * r.control_points[k - n]);
          });
  found.position_m_s2 =
      rms(seenSegments(input, state, p.start_s, p.knot_spacing_s, p.segmentCount()), p.knot_spacing_s,
          [&](std::size_t k, std::size_t n) -> Eigen::Vector3d {
            return p.control_points[k] - 2.0 * p.control_points[k - n] + p.control_points[k - 2 * n];
          });
  return found;
}

}  // namespace evical
