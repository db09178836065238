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

std::optional<CircleImage> imageOfCircle(const Eigen::Matrix3d& h, const BoardScene& scene, int index) {
  const Eigen::Vector2d c = scene.board.point_m(index);
  const double r2 = scene.board.radius_m * scene.board.radius_m;
  Eigen::Matrix3d dual;
  dual << c.x() * c.x() - r2, c.x() * c.y(), c.x(), c.x() * c.y(), c.y() * c.y() - r2, c.y(), c.x(), c.y(),
      1.0;
  const Eigen::Matrix3d q = h * dual * h.transpose();
  if (!((h * Eigen::Vector3d(c.x(), c.y(), 1.0)).z() > 0.0) || !(q(2, 2) > 0.0)) return std::nullopt;
  CircleImage out;
  out.circle = index;
  out.centre_px = q.topRightCorner<2, 1>() / q(2, 2);
  // Dual conic about its own centre: minus the matrix of squared semi-axes.
  const Eigen::Matrix2d axes2 = out.centre_px * out.centre_px.transpose() - q.topLeftCorner<2, 2>() / q(2, 2);
  const double det = axes2.determinant();
  if (!(det > 0.0) || !(axes2.trace() > 0.0)) return std::nullopt;
  out.shape = axes2.inverse();
  const double half_trace = 0.5 * axes2.trace();
  out.max_radius_px = std::sqrt(half_trace + std::sqrt(std::max(half_trace * half_trace - det, 0.0)));
  out.sensor_centre_px = out.centre_px;
  out.sensor_radius_px = out.max_radius_px;
  if (scene.camera) {
    out.sensor_centre_px = pixelFromIdeal(*scene.camera, out.centre_px);
    const double scale = std::sqrt(std::abs(idealPixelScale(*scene.camera, out.centre_px).determinant()));
    if (!(scale > 1e-3)) return std::nullopt;
    out.sensor_radius_px = out.max_radius_px / scale;
  }
  return out;
}

std::vector<CircleImage> projectBoard(const Eigen::Matrix3d& ideal_from_board, const BoardScene& scene) {
  std::vector<CircleImage> circles;
  for (int i = 0; i < scene.board.pointCount(); ++i) {
    std::optional<CircleImage> circle = imageOfCircle(ideal_from_board, scene, i);
    if (!circle) continue;
    const double r = circle->sensor_radius_px;
    const Eigen::Vector2d& c = circle->sensor_centre_px;
    if (c.x() < -r || c.y() < -r || c.x() > scene.resolution_px.width_px + r ||
        c.y() > scene.resolution_px.height_px + r)
      continue;
    circles.push_back(*circle);
  }
  return circles;
}

bool insideImage(const CircleImage& circle, Resolution resolution_px) {
  const double r = circle.sensor_radius_px;
  const Eigen::Vector2d& c = circle.sensor_centre_px;
  return c.x() >= r && c.y() >= r && c.x() <= resolution_px.width_px - 1 - r &&
         c.y() <= resolution_px.height_px - 1 - r;
}

double boardSpeed_px_s(const BoardMotion& motion, const BoardScene& scene) {
  const std::vector<CircleImage> circles = projectBoard(motion.ideal_from_board, scene);
  double sum = 0.0;
  for (const CircleImage& circle : circles) {
    const double sensor_scale = circle.sensor_radius_px / circle.max_radius_px;
    sum += motion.velocityAt(circle.centre_px).norm() * sensor_scale;
  }
  return circles.empty() ? 0.0 : sum / static_cast<double>(circles.size());
}

std::vector<int> circlesExpected(const BoardMotion& motion, const BoardScene& scene, double half_window_s) {
  constexpr double kMinTravel_px = 1.2;  // an edge that stays within a pixel fires few events or none
  std::vector<int> expected;
  for (const CircleImage& circle : projectBoard(motion.ideal_from_board, scene)) {
    const double sensor_scale = circle.sensor_radius_px / circle.max_radius_px;
    const double travel_px = motion.velocityAt(circle.centre_px).norm() * sensor_scale * 2.0 * half_window_s;
    if (insideImage(circle, scene.resolution_px) && travel_px > kMinTravel_px)
      expected.push_back(circle.circle);
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
