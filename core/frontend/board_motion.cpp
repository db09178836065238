#include "core/frontend/board_motion.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

constexpr int kFlowTerms = 8;
constexpr int kUnknowns = 2 * kFlowTerms + 1;  // shift, velocity, radius offset
using NormalMatrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using NormalVector = Eigen::Matrix<double, kUnknowns, 1>;

struct NormalEquations {
  NormalMatrix matrix = NormalMatrix::Zero();
  NormalVector vector = NormalVector::Zero();
  double weighted_squares = 0.0, weight = 0.0;
  int bursts = 0;
};

// How far velocities may change from one window to the next, in px/s; the prior only keeps what the bursts do
// not see.
constexpr double kVelocitySigmaPerPixel = 40.0;

void addPriors(const TrackingOptions& options, const NormalVector& from_start, NormalEquations& equations) {
  for (int i = 0; i < kUnknowns; ++i) {
    const bool perspective = (i % kFlowTerms) >= 6 && i < 2 * kFlowTerms;
    double sigma = options.prediction_sigma_px;
    if (i >= kFlowTerms) sigma *= kVelocitySigmaPerPixel;
    if (perspective) sigma *= 0.5;
    if (i == kUnknowns - 1) sigma = 1.0;
    const double weight = 1.0 / (sigma * sigma);
    equations.matrix(i, i) += weight;
    equations.vector(i) -= weight * from_start(i);
  }
}

void addCircle(const BurstWindow& window, const ProjectedCircle& circle, const BoardMotion& motion,
               double half_window_s, double gate_px, const TrackingOptions& options,
               NormalEquations& equations) {
  const Eigen::Vector2d velocity = motion.velocityAt(circle.centre_px);
  const double speed = velocity.norm();
  if (speed < 1e-3) return;
  const Eigen::Vector2d direction = velocity / speed;
  const double inverse_scale2 = 1.0 / (options.robust_scale_px * options.robust_scale_px);
  const double sensor_scale = circle.sensor_radius_px / circle.largest_radius_px;
  const double reach = circle.sensor_radius_px + gate_px + speed * half_window_s * sensor_scale;
  const Eigen::Vector2d& middle = circle.sensor_centre_px;
  window.visitBox(
      middle.x() - reach, middle.x() + reach, middle.y() - reach, middle.y() + reach, [&](std::uint32_t i) {
        const WindowBurst& burst = window.bursts()[i];
        if (std::abs(burst.time_s) > half_window_s) return;
        const Eigen::Vector2d pixel(burst.ideal_x_px, burst.ideal_y_px);
        const Eigen::Vector2d at_middle = pixel - velocity * static_cast<double>(burst.time_s);
        // The circle's own velocity tells quickly what is far away; the field's decides.
        if ((at_middle - circle.centre_px).norm() > circle.largest_radius_px + 2.0 * gate_px * burst.scale)
          return;
        const PlaneFlowBasis basis = motion.frame.basis(pixel);
        const Eigen::Vector2d warped =
            pixel - basis * motion.velocity_px_s * static_cast<double>(burst.time_s);
        const EdgeDistance edge = distanceToEdge(circle, warped);
        const double scale = burst.scale;
        const double residual = edge.distance_px / scale - motion.radius_offset_px;
        if (!(std::abs(residual) < gate_px)) return;
        if (burst.lead * edge.normal.dot(direction) < options.least_polarity_cosine) return;
        const double weight = 1.0 / (1.0 + residual * residual * inverse_scale2);
        const Eigen::Matrix<double, 1, 8> along = edge.normal.transpose() * basis / scale;
        Eigen::Matrix<double, 1, kUnknowns> row;
        row << -along, -along * static_cast<double>(burst.time_s), -1.0;
        equations.matrix.selfadjointView<Eigen::Lower>().rankUpdate(row.transpose(), weight);
        equations.vector -= weight * residual * row.transpose();
        equations.weighted_squares += weight * residual * residual;
        equations.weight += weight;
        ++equations.bursts;
      });
}

// Mean speed of the circles in the sensor's pixels.
double meanSpeed_px_s(const std::vector<ProjectedCircle>& circles, const BoardMotion& motion) {
  double sum = 0.0;
  for (const ProjectedCircle& circle : circles) {
    const double sensor_scale = circle.sensor_radius_px / circle.largest_radius_px;
    sum += motion.velocityAt(circle.centre_px).norm() * sensor_scale;
  }
  return circles.empty() ? 0.0 : sum / static_cast<double>(circles.size());
}

}  // namespace

namespace {

Eigen::Matrix3d normaliser(const ImageFrame& frame) {
  Eigen::Matrix3d n;
  n << 1.0 / frame.scale_px, 0.0, -frame.centre_px.x() / frame.scale_px, 0.0, 1.0 / frame.scale_px,
      -frame.centre_px.y() / frame.scale_px, 0.0, 0.0, 1.0;
  return n;
}

// The same flow about another centre: the family is closed under shifts (conjugation of its generator).
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

Eigen::Matrix3d moved(const Eigen::Matrix3d& ideal_from_board, const ImageFrame& frame, const PlaneFlow& f) {
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
  next.ideal_from_board = moved(motion.ideal_from_board, motion.frame, motion.velocity_px_s * dt);
  // The frame goes with the board.
  next.frame.centre_px += motion.frame.flow(motion.velocity_px_s, motion.frame.centre_px) * dt;
  next.velocity_px_s = reframed(motion.velocity_px_s, motion.frame, next.frame);
  return next;
}

std::optional<ProjectedCircle> projectCircle(const Eigen::Matrix3d& h, const CircleBoard& board, int index,
                                             const std::optional<CameraIntrinsics>& camera) {
  const Eigen::Vector2d c = board.centre_m(index);
  const double r2 = board.radius_m * board.radius_m;
  Eigen::Matrix3d dual;
  dual << c.x() * c.x() - r2, c.x() * c.y(), c.x(), c.x() * c.y(), c.y() * c.y() - r2, c.y(), c.x(), c.y(),
      1.0;
  const Eigen::Matrix3d q = h * dual * h.transpose();
  if (!((h * Eigen::Vector3d(c.x(), c.y(), 1.0)).z() > 0.0) || !(q(2, 2) > 0.0)) return std::nullopt;
  ProjectedCircle out;
  out.circle = index;
  out.centre_px = q.topRightCorner<2, 1>() / q(2, 2);
  // Dual conic about its own centre: minus the matrix of squared semi-axes.
  const Eigen::Matrix2d axes2 = out.centre_px * out.centre_px.transpose() - q.topLeftCorner<2, 2>() / q(2, 2);
  const double det = axes2.determinant();
  if (!(det > 0.0) || !(axes2.trace() > 0.0)) return std::nullopt;
  out.shape = axes2.inverse();
  const double half_trace = 0.5 * axes2.trace();
  out.largest_radius_px = std::sqrt(half_trace + std::sqrt(std::max(half_trace * half_trace - det, 0.0)));
  out.sensor_centre_px = out.centre_px;
  out.sensor_radius_px = out.largest_radius_px;
  if (camera) {
    out.sensor_centre_px = pixelFromIdeal(*camera, out.centre_px);
    const double scale = std::sqrt(std::abs(idealPixelScale(*camera, out.centre_px).determinant()));
    if (!(scale > 1e-3)) return std::nullopt;
    out.sensor_radius_px = out.largest_radius_px / scale;
  }
  return out;
}

std::vector<ProjectedCircle> projectBoard(const Eigen::Matrix3d& ideal_from_board, const CircleBoard& board,
                                          const std::optional<CameraIntrinsics>& camera,
                                          Resolution resolution_px) {
  std::vector<ProjectedCircle> circles;
  for (int i = 0; i < board.circleCount(); ++i) {
    std::optional<ProjectedCircle> circle = projectCircle(ideal_from_board, board, i, camera);
    if (!circle) continue;
    const double r = circle->sensor_radius_px;
    const Eigen::Vector2d& c = circle->sensor_centre_px;
    if (c.x() < -r || c.y() < -r || c.x() > resolution_px.width_px + r || c.y() > resolution_px.height_px + r)
      continue;
    circles.push_back(*circle);
  }
  return circles;
}

bool insideImage(const ProjectedCircle& circle, Resolution resolution_px) {
  const double r = circle.sensor_radius_px;
  const Eigen::Vector2d& c = circle.sensor_centre_px;
  return c.x() >= r && c.y() >= r && c.x() <= resolution_px.width_px - 1 - r &&
         c.y() <= resolution_px.height_px - 1 - r;
}

double boardSpeed_px_s(const BoardMotion& motion, const CircleBoard& board,
                       const std::optional<CameraIntrinsics>& camera, Resolution resolution_px) {
  return meanSpeed_px_s(projectBoard(motion.ideal_from_board, board, camera, resolution_px), motion);
}

double fitHalfWindow_s(double speed_px_s, const TrackingOptions& options) {
  return std::min(options.fit_travel_px / (2.0 * std::max(speed_px_s, 1.0)),
                  options.longest_fit_half_window_s);
}

std::optional<BoardMotion> fitBoardMotion(const BurstWindow& window, const BoardMotion& start,
                                          const CircleBoard& board,
                                          const std::optional<CameraIntrinsics>& camera, double first_gate_px,
                                          const TrackingOptions& options) {
  BoardMotion motion = start;
  std::vector<ProjectedCircle> circles =
      projectBoard(motion.ideal_from_board, board, camera, window.resolution_px());
  if (circles.empty()) return std::nullopt;
  const double half_window_s = fitHalfWindow_s(meanSpeed_px_s(circles, motion), options);
  NormalVector from_start = NormalVector::Zero();
  const double gate_ratio =
      std::pow(options.last_gate_px / first_gate_px, 1.0 / std::max(options.iterations - 2, 1));
  double gate_px = first_gate_px;
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    NormalEquations equations;
    for (const ProjectedCircle& circle : circles) {
      addCircle(window, circle, motion, half_window_s, gate_px, options, equations);
    }
    if (equations.bursts < 3 * kUnknowns) return std::nullopt;
    addPriors(options, from_start, equations);
    const NormalVector step = equations.matrix.selfadjointView<Eigen::Lower>().ldlt().solve(equations.vector);
    if (!step.allFinite()) return std::nullopt;
    from_start += step;
    motion.ideal_from_board = moved(motion.ideal_from_board, motion.frame, step.head<kFlowTerms>());
    motion.velocity_px_s += step.segment<kFlowTerms>(kFlowTerms);
    motion.radius_offset_px += step(kUnknowns - 1);
    motion.residual_rms_px = std::sqrt(equations.weighted_squares / equations.weight);
    motion.bursts = equations.bursts;
    circles = projectBoard(motion.ideal_from_board, board, camera, window.resolution_px());
    if (circles.empty()) return std::nullopt;
    gate_px = std::max(gate_px * gate_ratio, options.last_gate_px);
  }
  return motion;
}

}  // namespace evical
