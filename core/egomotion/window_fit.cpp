#include "core/egomotion/window_fit.h"

#include "core/base/time.h"
#include "core/numerics/robust.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical {

ImageMotion rotationalMotion(const Eigen::Vector2d& place) {
  const double x = place.x(), y = place.y();
  ImageMotion motion;
  motion << x * y, -(1.0 + x * x), y, 1.0 + y * y, -x * y, -x;
  return motion;
}

ImageMotion translationalMotion(const Eigen::Vector2d& place) {
  ImageMotion motion;
  motion << -1.0, 0.0, place.x(), 0.0, -1.0, place.y();
  return motion;
}

std::vector<EdgeRow> edgeRows(std::span<const EdgeSlope> slopes, const LensRays& lens, std::int64_t begin_ns,
                              const EgomotionOptions& options) {
  std::vector<EdgeRow> rows;
  rows.reserve(slopes.size());
  const Resolution size = lens.resolution_px();
  const std::size_t step = 1 + slopes.size() / static_cast<std::size_t>(options.max_slopes);
  for (std::size_t k = 0; k < slopes.size(); k += step) {
    const EdgeSlope& slope = slopes[k];
    const LensRays::Ray& ray = lens.at(slope.x_px, slope.y_px);
    if (!ray.known) continue;
    EdgeRow& row = rows.emplace_back();
    const Eigen::Matrix2d px_per_place = ray.px_per_place.cast<double>();
    const Eigen::Vector2d place = ray.place.cast<double>();
    row.slope = px_per_place.transpose() * slope.slope_s_px.cast<double>();
    const double time_s = options.time_noise_s,
                 passing_s = options.place_noise_px * static_cast<double>(slope.slope_s_px.norm());
    row.variance = (time_s * time_s + passing_s * passing_s) *
                   (px_per_place.transpose() * slope.covarianceAt1s() * px_per_place);
    const int column = slope.x_px * options.depth_columns / size.width_px,
              line = slope.y_px * options.depth_rows / size.height_px;
    row.patch = static_cast<std::size_t>(line * options.depth_columns + column);
    row.time_s = secondsSince(begin_ns, slope.time_ns);
    row.by_rotation = rotationalMotion(place);
    row.by_translation = translationalMotion(place);
  }
  return rows;
}

EdgeResidual edgeResidual(const EdgeRow& row, const Eigen::Vector3d& rate_rad_s,
                          const Eigen::Vector3d& velocity_1_s) {
  EdgeResidual out;
  out.translational = row.by_translation * velocity_1_s;
  const Eigen::Vector2d flow = row.by_rotation * (row.known_rate_rad_s + rate_rad_s) + out.translational;
  const Eigen::Vector2d noisy = row.variance * flow;
  constexpr double kMinVariance = 1e-12;
  const double sigma = std::sqrt(flow.dot(noisy) + row.depth_variance + kMinVariance);
  out.error = row.slope.dot(flow) - 1.0;
  out.value = out.error / sigma;
  out.by_flow = row.slope / sigma - out.error / (sigma * sigma * sigma) * noisy;
  return out;
}

namespace {

constexpr double kCauchySigmas = 2.385;  // 95 % of least squares' efficiency
constexpr double kInlierSigmas = 3.0,
                 kInlierError = 0.3;  // limits of inliers: sigmas, or relative to the speed
constexpr double kHeldDepth = 1e9;

}  // namespace

WindowFit::WindowFit(std::vector<EdgeRow> rows, const EgomotionOptions& options, double velocity_information)
    : rows_(std::move(rows)), options_(options), velocity_information_(velocity_information) {}

bool WindowFit::start(WindowUnknowns unknowns) {
  constexpr int kIterations = 6;
  constexpr double kScale = 0.4;
  unknowns_ = unknowns;
  Vector6d twist = Vector6d::Zero();
  for (int k = 0; k < kIterations; ++k) {
    Matrix6d normal = Matrix6d::Identity() * 1e-6;
    Vector6d right = Vector6d::Zero();
    for (const EdgeRow& row : rows_) {
      Vector6d j;
      j << row.by_rotation.transpose() * row.slope, row.by_translation.transpose() * row.slope;
      const double wanted = 1.0 - j.head<3>().dot(row.known_rate_rad_s), error = j.dot(twist) - wanted;
      const double weight = k == 0 ? 1.0 : cauchyWeight(error * error / (kScale * kScale));
      normal += weight * j * j.transpose();
      right += weight * wanted * j;
    }
    normal.diagonal() += held(kHeldDepth);
    twist = normal.ldlt().solve(right);
    if (!twist.allFinite()) return false;
  }
  const auto patches = static_cast<std::size_t>(options_.depth_columns * options_.depth_rows);
  state_ = {twist.head<3>(), twist.tail<3>(), std::vector<double>(patches, 0.0)};
  return true;
}

void WindowFit::startFrom(WindowState state, WindowUnknowns unknowns) {
  state_ = std::move(state);
  unknowns_ = unknowns;
}

void WindowFit::refine() {
  constexpr int kIterations = 8;
  constexpr double kEnough = 1e-5;  // relative change of the cost
  rescale();
  double cost = costOf(state_);
  for (int k = 0; k < kIterations; ++k) {
    build();
    double damping = 0.0, before = cost;
    bool better = false;
    for (int attempt = 0; attempt < 4 && !better; ++attempt) {
      WindowState tried = stepped(damping);
      const double new_cost = costOf(tried);
      if (new_cost < cost) {
        better = true;
        state_ = std::move(tried);
        cost = new_cost;
      }
      damping = damping == 0.0 ? 1e-2 : 30.0 * damping;
    }
    if (!better || before - cost < kEnough * cost) break;
    if (k == 1 || k == 3) {
      rescale();
      cost = costOf(state_);
    }
  }
  rescale();
  build();
}

double WindowFit::weightOf(const EdgeResidual& residual) const {
  const double value = residual.value / (kCauchySigmas * scale_);
  return cauchyWeight(value * value);
}

double WindowFit::curvatureOf(const EdgeResidual& residual) const {
  const double value = residual.value / (kCauchySigmas * scale_), square = value * value;
  return (1.0 - square) / ((1.0 + square) * (1.0 + square));
}

WindowFit::Matrix6d WindowFit::covariance(double shared) const {
  Matrix6d information = normal_.reduced().normal;
  information.diagonal() += held(kHeldDepth) + Vector6d::Constant(1e-9);
  return shared * information.inverse();
}

double WindowFit::inlierShare() const {
  double inliers = 0.0;
  for (const EdgeRow& row : rows_) {
    const EdgeResidual r = seen(row).residual;
    inliers += std::abs(r.error) < kInlierError || std::abs(r.value) < kInlierSigmas;
  }
  return inliers / static_cast<double>(rows_.size());
}

double WindowFit::medianSquare() const {
  std::vector<double> squares;
  for (const EdgeRow& row : rows_) {
    const double value = seen(row).residual.value;
    squares.push_back(value * value);
  }
  return medianOf(std::move(squares));
}

WindowFit::Seen WindowFit::seenAs(const EdgeRow& row, const WindowState& state) {
  const double nearness = std::exp(state.log_nearness[row.patch]);
  return {edgeResidual(row, state.rate_rad_s, nearness * state.velocity_1_s), nearness};
}

WindowFit::Vector6d WindowFit::held(double size) const {
  Vector6d diagonal = Vector6d::Zero();
  if (unknowns_ == WindowUnknowns::Rotation) diagonal.tail<3>().setConstant(size);
  if (unknowns_ == WindowUnknowns::Translation) diagonal.head<3>().setConstant(size);
  return diagonal;
}

// Accuracy of the translation for each edge, and the fit of the motion to all of them.
void WindowFit::rescale() {
  std::vector<double> sizes;
  for (EdgeRow& row : rows_) {
    const double size = options_.depth_error * row.slope.dot(seen(row).residual.translational);
    row.depth_variance = size * size;
    sizes.push_back(std::abs(seen(row).residual.value));
  }
  scale_ = std::max(kMadToSigma * medianOf(std::move(sizes)), 1e-6);
}

double WindowFit::costOf(const WindowState& state) const {
  double cost = 0.0;
  const double unit = kCauchySigmas * scale_;
  for (const EdgeRow& row : rows_) {
    const double value = seenAs(row, state).residual.value / unit;
    cost += kCauchySigmas * kCauchySigmas * std::log1p(value * value);
  }
  const double spread = options_.depth_spread;
  for (const double log_nearness : state.log_nearness)
    cost += log_nearness * log_nearness / (spread * spread);
  return cost + velocity_information_ * state.velocity_1_s.squaredNorm();
}

void WindowFit::build() {
  normal_.begin(state_.log_nearness, options_.depth_spread);
  normal_.expectNone(velocity_information_, state_.velocity_1_s);
  for (const EdgeRow& row : rows_) {
    const auto [residual, nearness] = seen(row);
    Vector6d j;
    j << row.by_rotation.transpose() * residual.by_flow,
        nearness * (row.by_translation.transpose() * residual.by_flow);
    const double weight = weightOf(residual) / (scale_ * scale_);
    normal_.add(weight, weight * residual.value, j, row.patch, residual.translational.dot(residual.by_flow));
  }
}

WindowState WindowFit::stepped(double damping) const {
  auto [normal, right] = normal_.reduced(damping);
  normal.diagonal() += damping * normal_.diagonal() + held(kHeldDepth) + Vector6d::Constant(1e-9);
  const Vector6d step = normal.ldlt().solve(right);
  WindowState next = state_;
  next.rate_rad_s += step.head<3>();
  next.velocity_1_s += step.tail<3>();
  normal_.moveDepths(step, damping, next.log_nearness);
  return next;
}

}  // namespace evical
