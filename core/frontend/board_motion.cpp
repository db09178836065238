#include "core/frontend/board_motion.h"

#include "core/geometry/camera_model.h"
#include "core/numerics/robust.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

Eigen::Matrix3d normaliser(const ImageFrame& frame) {
  Eigen::Matrix3d n;
  n << 1.0 / frame.scale_px, 0.0, -frame.centre_px.x() / frame.scale_px, 0.0, 1.0 / frame.scale_px,
      -frame.centre_px.y() / frame.scale_px, 0.0, 0.0, 1.0;
  return n;
}

// The same flow relative to another centre: the family is closed under shifts (conjugation of its generator).
PlaneFlow reframed(const PlaneFlow& f, const ImageFrame& from, const ImageFrame& to) {
  const double s = from.scale_px;
  Eigen::Matrix3d generator;
  generator << f(1) / s, f(2) / s, f(0) / s, f(4) / s, f(5) / s, f(3) / s, -f(6) / s, -f(7) / s, 0.0;
  const Eigen::Matrix3d to_from_from = normaliser(to) * normaliser(from).inverse();
  Eigen::Matrix3d g = to_from_from * generator * to_from_from.inverse();
  g -= g(2, 2) * Eigen::Matrix3d::Identity();
  g *= to.scale_px;
  return (PlaneFlow() << g(0, 2), g(0, 0), g(0, 1), g(1, 2), g(1, 0), g(1, 1), -g(2, 0), -g(2, 1)).finished();
}

}  // namespace

PlaneFlowBasis ImageFrame::basis(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d n = (pixel - centre_px) / scale_px;
  const double x = n.x(), y = n.y();
  PlaneFlowBasis b;
  b << 1.0, x, y, 0.0, 0.0, 0.0, x * x, x * y,  //
      0.0, 0.0, 0.0, 1.0, x, y, x * y, y * y;
  return b;
}

Eigen::Vector2d ImageFrame::flow(const PlaneFlow& f, const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d n = (pixel - centre_px) / scale_px;
  const double x = n.x(), y = n.y(), bend = f(6) * x + f(7) * y;
  return {f(0) + f(1) * x + f(2) * y + x * bend, f(3) + f(4) * x + f(5) * y + y * bend};
}

Eigen::Matrix2d ImageFrame::gradient(const PlaneFlow& f, const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d n = (pixel - centre_px) / scale_px;
  const double x = n.x(), y = n.y();
  Eigen::Matrix2d g;
  g << f(1) + 2.0 * f(6) * x + f(7) * y, f(2) + f(7) * x, f(4) + f(6) * y, f(5) + f(6) * x + 2.0 * f(7) * y;
  return g / scale_px;
}

Eigen::Matrix3d warped(const Eigen::Matrix3d& ideal_from_board, const ImageFrame& frame, const PlaneFlow& f) {
  const double s = frame.scale_px;
  const Eigen::Matrix3d n = normaliser(frame);
  Eigen::Matrix3d step;
  step << 1.0 + f(1) / s, f(2) / s, f(0) / s, f(4) / s, 1.0 + f(5) / s, f(3) / s, -f(6) / s, -f(7) / s, 1.0;
  const Eigen::Matrix3d h = n.inverse() * step * n * ideal_from_board;
  return h / h(2, 2);
}

BoardMotion predicted(const BoardMotion& motion, std::int64_t time_ns) {
  BoardMotion next = motion;
  const double dt = static_cast<double>(time_ns - motion.time_ns) * 1e-9;
  next.time_ns = time_ns;
  const PlaneFlow travel_px = dt * (motion.velocity_px_s + 0.5 * dt * motion.acceleration_px_s2);
  next.ideal_from_board = warped(motion.ideal_from_board, motion.frame, travel_px);
  // The frame moves with the board.
  next.frame.centre_px += motion.frame.flow(travel_px, motion.frame.centre_px);
  next.velocity_px_s =
      reframed(motion.velocity_px_s + dt * motion.acceleration_px_s2, motion.frame, next.frame);
  next.acceleration_px_s2 = reframed(motion.acceleration_px_s2, motion.frame, next.frame);
  return next;
}

double boardSpeed_px_s(const BoardMotion& motion, const BoardScene& scene) {
  const std::vector<OutlineImage> outlines = projectBoard(motion.ideal_from_board, scene);
  double sum = 0.0;
  for (const OutlineImage& outline : outlines)
    sum += motion.velocityAt(outline.centre_px).norm() / outline.scale();
  return outlines.empty() ? 0.0 : sum / static_cast<double>(outlines.size());
}

std::vector<int> circlesExpected(const BoardMotion& motion, const BoardScene& scene, double half_window_s) {
  constexpr double kMinTravel_px = 1.2;  // an edge that stays within a pixel fires few events or none
  std::vector<int> expected;
  for (int index = 0; index < scene.board.pointCount(); ++index) {
    const std::optional<PointImage> point = imageOfPoint(motion.ideal_from_board, scene, index);
    if (!point || !insideImage(*point, scene.resolution_px)) continue;
    const Eigen::Vector2d travel_px =
        2.0 * half_window_s / point->scale * motion.velocityAt(point->centre_px);
    const auto moves = [&](std::size_t arm) {
      return point->shown[arm] && std::abs(point->outlines[arm].normal.dot(travel_px)) > kMinTravel_px;
    };
    const bool expects =
        point->is_corner ? moves(0) || moves(1) || moves(2) || moves(3) : travel_px.norm() > kMinTravel_px;
    if (expects) expected.push_back(index);
  }
  return expected;
}

double fitHalfWindow_s(double speed_px_s, const TrackingOptions& options) {
  return std::min(options.fit_travel_px / (2.0 * std::max(speed_px_s, 1.0)), options.max_fit_half_window_s);
}

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
