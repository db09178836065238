#include "core/frontend/moving_circle.h"

#include "core/numerics/robust.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace evical {
namespace {

constexpr int kSectors = 16;
constexpr std::array kSpeedFactors = {1.0, 0.4, 2.2};

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

struct CirclePoint {
  double x, y, t, lead;
};

struct CircleSums {
  Matrix5 matrix;
  Vector5 vector;
  double weight = 0.0, squares = 0.0;
  int bursts = 0, leading = 0, trailing = 0;
  unsigned sectors = 0;
};

// One pass over the points; the scale of the radius widens the gate for large circles, which tilt makes
// elliptic.
CircleSums sumUp(const std::vector<CirclePoint>& points, const MovingCircle& circle, double gate_px,
                 const MovingCircleOptions& options, bool normal_equations) {
  CircleSums sums;
  sums.matrix.setZero();
  sums.vector.setZero();
  const double speed = circle.velocity_px_s.norm();
  const double inverse_scale2 = 1.0 / (options.robust_scale_px * options.robust_scale_px);
  for (const CirclePoint& point : points) {
    const double dx = point.x - circle.centre_px.x() - circle.velocity_px_s.x() * point.t;
    const double dy = point.y - circle.centre_px.y() - circle.velocity_px_s.y() * point.t;
    const double distance = std::sqrt(dx * dx + dy * dy);
    const double r = distance - circle.radius_px;
    if (std::abs(r) > gate_px || distance < 1e-6) continue;
    const double nx = dx / distance, ny = dy / distance;
    const double cosine = point.lead * (nx * circle.velocity_px_s.x() + ny * circle.velocity_px_s.y());
    if (cosine < options.min_polarity_cosine * speed) continue;
    const double w = cauchyWeight(r * r * inverse_scale2);
    sums.weight += w;
    sums.squares += w * r * r;
    ++sums.bursts;
    (point.lead > 0.0 ? sums.leading : sums.trailing) += 1;
    const double angle = std::atan2(ny, nx);
    sums.sectors |= 1u << (static_cast<int>((angle / (2.0 * M_PI) + 1.0) * kSectors) % kSectors);
    if (!normal_equations) continue;
    Vector5 row;
    row << -nx, -ny, -nx * point.t, -ny * point.t, -1.0;
    sums.matrix.noalias() += w * row * row.transpose();
    sums.vector -= w * r * row;
  }
  return sums;
}

double gateAt(int iteration, double radius_px, const MovingCircleOptions& options) {
  const double loosened = std::max(1.0, 0.06 * radius_px);
  const double part = static_cast<double>(iteration) / std::max(options.iterations - 1, 1);
  return loosened * (options.first_gate_px + part * (options.last_gate_px - options.first_gate_px));
}

std::optional<MovingCircle> fitFrom(MovingCircle circle, const std::vector<CirclePoint>& points,
                                    const MovingCircleOptions& options) {
  const double first_radius_px = circle.radius_px;
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    CircleSums sums = sumUp(points, circle, gateAt(iteration, first_radius_px, options), options, true);
    if (sums.bursts < 8) return std::nullopt;
    // Velocities are in px/s: a prior of 0 +- 1000 px/s, and one of a whole gate for the other parameters,
    // keep the matrix regular.
    sums.matrix.diagonal() += (Vector5() << 1e-3, 1e-3, 1e-7, 1e-7, 1e-3).finished();
    const Vector5 step = sums.matrix.ldlt().solve(sums.vector);
    if (!step.allFinite()) return std::nullopt;
    circle.centre_px += step.head<2>();
    circle.velocity_px_s += step.segment<2>(2);
    circle.radius_px += step(4);
    if (circle.radius_px < 0.5 * first_radius_px || circle.radius_px > 2.0 * first_radius_px)
      return std::nullopt;
  }
  const CircleSums sums =
      sumUp(points, circle, gateAt(options.iterations, first_radius_px, options), options, false);
  const double loosened = std::max(1.0, 0.06 * first_radius_px);
  circle.bursts = sums.bursts;
  circle.sectors = std::popcount(sums.sectors);
  if (sums.weight <= 0.0 || circle.sectors < options.min_bins) return std::nullopt;
  if (std::min(sums.leading, sums.trailing) < options.min_bursts_per_polarity) return std::nullopt;
  circle.rms_px = std::sqrt(sums.squares / sums.weight) / loosened;
  if (circle.rms_px > options.max_rms_px) return std::nullopt;
  return circle;
}

double quality(const MovingCircle& circle) {
  return circle.bursts * circle.sectors / (0.2 + circle.rms_px);
}

}  // namespace

double typicalEdgeSpeed_px_s(const BurstWindow& window) {
  const Resolution resolution = window.resolution_px();
  const int stride = resolution.width_px + 2;
  std::array<std::vector<float>, 2> times;
  constexpr float kNever = 1e9f;
  for (auto& plane : times)
    plane.assign(static_cast<std::size_t>(stride * (resolution.height_px + 2)), kNever);
  for (const WindowBurst& burst : window.bursts()) {
    float& time = times[burst.lead > 0.0f][static_cast<std::size_t>(
        (static_cast<int>(burst.y_px) + 1) * stride + static_cast<int>(burst.x_px) + 1)];
    if (std::abs(burst.time_s) < std::abs(time)) time = burst.time_s;
  }
  std::vector<float> speeds;
  for (const auto& plane : times) {
    for (int y = 1; y <= resolution.height_px; ++y) {
      for (int x = 1; x <= resolution.width_px; ++x) {
        const float* const centre = plane.data() + y * stride + x;
        const float t = *centre;
        if (t == kNever) continue;
        const float left = centre[-1], right = centre[1], up = centre[-stride], down = centre[stride];
        if (left == kNever || right == kNever || up == kNever || down == kNever) continue;
        // Criterion for the order of an edge's passing times: the middle pixel's is between its neighbours'
        // or near them.
        const float a = 0.5f * (right - left), b = 0.5f * (down - up);
        const float slope2 = a * a + b * b;
        const float bend = std::abs(left + right - 2.0f * t) + std::abs(up + down - 2.0f * t);
        if (slope2 <= 0.0f || bend * bend > 4.0f * slope2) continue;
        speeds.push_back(1.0f / std::sqrt(slope2));
      }
    }
  }
  constexpr std::size_t kMin = 30;
  if (speeds.size() < kMin) return 0.0;
  return medianOf(std::move(speeds));
}

std::optional<MovingCircle> fitMovingCircle(const BurstWindow& window, const CircleCandidate& candidate,
                                            double speed_px_s, const MovingCircleOptions& options) {
  const double reach = 1.3 * candidate.radius_px + 3.0 * options.first_gate_px;
  const Eigen::Vector2d c = candidate.centre_px;
  std::vector<CirclePoint> points;
  window.visitBox(c.x() - reach, c.x() + reach, c.y() - reach, c.y() + reach, [&](std::uint32_t i) {
    const WindowBurst& b = window.bursts()[i];
    points.push_back({b.x_px, b.y_px, b.time_s, b.lead});
  });
  std::optional<MovingCircle> best;
  for (const double factor : kSpeedFactors) {
    MovingCircle start;
    start.centre_px = c;
    start.radius_px = candidate.radius_px;
    const double speed = candidate.speed_px_s > 0.0 ? candidate.speed_px_s : speed_px_s * factor;
    start.velocity_px_s = candidate.direction * speed;
    const std::optional<MovingCircle> fit = fitFrom(start, points, options);
    if (fit && (!best || quality(*fit) > quality(*best))) best = fit;
    if (candidate.speed_px_s > 0.0) break;
  }
  return best;
}

std::vector<MovingCircle> fitMovingCircles(const BurstWindow& window,
                                           const std::vector<CircleCandidate>& candidates, double speed_px_s,
                                           const MovingCircleOptions& options) {
  std::vector<MovingCircle> fits;
  for (const CircleCandidate& candidate : candidates) {
    if (const std::optional<MovingCircle> fit = fitMovingCircle(window, candidate, speed_px_s, options)) {
      fits.push_back(*fit);
    }
  }
  std::sort(fits.begin(), fits.end(),
            [](const MovingCircle& a, const MovingCircle& b) { return quality(a) > quality(b); });
  std::vector<MovingCircle> kept;
  for (const MovingCircle& fit : fits) {
    const bool overlaps = std::any_of(kept.begin(), kept.end(), [&](const MovingCircle& other) {
      return (other.centre_px - fit.centre_px).norm() < 0.8 * std::max(other.radius_px, fit.radius_px);
    });
    if (!overlaps) kept.push_back(fit);
  }
  return kept;
}

}  // namespace evical
