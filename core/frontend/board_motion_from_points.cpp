#include "core/frontend/board_motion_from_points.h"

#include "core/numerics/robust.h"

#include <Eigen/Cholesky>

#include <algorithm>

namespace evical {

PlaneFlow fitPlaneFlow(const ImageFrame& frame, const std::vector<MovingPoint>& points) {
  Eigen::Matrix<double, 8, 8> matrix = Eigen::Matrix<double, 8, 8>::Zero();
  PlaneFlow flow = PlaneFlow::Zero();
  constexpr int kRounds = 5;
  constexpr double kScale_px_s = 20.0;  // of the Cauchy weight
  for (int round = 0; round < kRounds; ++round) {
    matrix.setZero();
    PlaneFlow vector = PlaneFlow::Zero();
    matrix.diagonal() << 1e-3, 0.05, 0.05, 1e-3, 0.05, 0.05, 1.0, 1.0;
    for (const MovingPoint& point : points) {
      const PlaneFlowBasis basis = frame.basis(point.centre_px);
      const Eigen::Vector2d error = point.velocity_px_s - basis * flow;
      const double w = round == 0 ? 1.0 : cauchyWeight(error.squaredNorm() / (kScale_px_s * kScale_px_s));
      matrix += w * basis.transpose() * basis;
      vector += w * basis.transpose() * point.velocity_px_s;
    }
    flow = matrix.ldlt().solve(vector);
  }
  return flow;
}

BoardMotion motionFromPoints(const Eigen::Matrix3d& ideal_from_board, const std::vector<MovingPoint>& points,
                             std::int64_t time_ns) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
  for (const MovingPoint& point : points) {
    low = low.cwiseMin(point.centre_px);
    high = high.cwiseMax(point.centre_px);
  }
  BoardMotion motion;
  motion.time_ns = time_ns;
  motion.ideal_from_board = ideal_from_board;
  motion.frame = {0.5 * (low + high), std::max(0.5 * (high - low).norm(), 1.0)};
  motion.velocity_px_s = fitPlaneFlow(motion.frame, points);
  return motion;
}

}  // namespace evical
