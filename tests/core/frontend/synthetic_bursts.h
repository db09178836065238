// Bursts of moving circles, from geometry alone: the times when a circle's edge is exactly at a pixel's
// centre, plus noise.
#pragma once

#include "core/frontend/board_motion.h"
#include "core/frontend/burst_window.h"
#include "core/frontend/edge_crossings.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <vector>

namespace evical::test {

inline constexpr Resolution kDavis_px = {346, 260};
inline constexpr std::uint16_t kBurstEvents = 6;

inline EdgeCrossing burstAt(int x_px, int y_px, double time_s, bool brighter) {
  return {static_cast<std::int64_t>(std::llround(time_s * 1e9)),
          1'000'000,
          static_cast<std::uint16_t>(x_px),
          static_cast<std::uint16_t>(y_px),
          kBurstEvents,
          brighter};
}

struct SyntheticCircle {
  Eigen::Vector2d centre_px = {0.0, 0.0};  // at time 0
  Eigen::Vector2d velocity_px_s = {0.0, 0.0};
  double radius_px = 0.0;
};

// Bursts within half_window_s of time 0. `noise_px` is that of an edge's position, along its normal.
inline void addBursts(const SyntheticCircle& circle, double half_window_s, CircleShade shade, double noise_px,
                      std::mt19937& random, std::vector<EdgeCrossing>& bursts) {
  std::normal_distribution<double> normal;
  const double speed2 = circle.velocity_px_s.squaredNorm();
  const double reach = circle.radius_px + std::sqrt(speed2) * half_window_s + 1.0;
  const int x_begin = std::max(0, static_cast<int>(circle.centre_px.x() - reach));
  const int x_end = std::min(kDavis_px.width_px, static_cast<int>(circle.centre_px.x() + reach) + 2);
  const int y_begin = std::max(0, static_cast<int>(circle.centre_px.y() - reach));
  const int y_end = std::min(kDavis_px.height_px, static_cast<int>(circle.centre_px.y() + reach) + 2);
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; ++x) {
      // |d - v t| = r
      const Eigen::Vector2d d = Eigen::Vector2d(x, y) - circle.centre_px;
      const double along = d.dot(circle.velocity_px_s);
      const double root2 = along * along - speed2 * (d.squaredNorm() - circle.radius_px * circle.radius_px);
      if (root2 <= 0.0) continue;
      const double root = std::sqrt(root2);
      for (const bool leading : {true, false}) {
        const double time_s = (along + (leading ? -root : root)) / speed2;
        const double normal_speed = root / circle.radius_px;  // |n . v| where the edge meets the pixel
        const double noisy_s = time_s + noise_px * normal(random) / normal_speed;
        if (std::abs(noisy_s) > half_window_s) continue;
        bursts.push_back(burstAt(x, y, noisy_s, leading != (shade == CircleShade::Dark)));
      }
    }
  }
}

inline void addRandomBursts(int count, double half_window_s, std::mt19937& random,
                            std::vector<EdgeCrossing>& bursts) {
  std::uniform_int_distribution<int> x(0, kDavis_px.width_px - 1), y(0, kDavis_px.height_px - 1), bit(0, 1);
  std::uniform_real_distribution<double> time(-half_window_s, half_window_s);
  for (int i = 0; i < count; ++i) {
    const int x_px = x(random), y_px = y(random);
    const double time_s = time(random);
    bursts.push_back(burstAt(x_px, y_px, time_s, bit(random) != 0));
  }
}

// A window over the DAVIS346's pixels whose middle is time 0.
struct SyntheticWindow {
  BurstWindow window;

  explicit SyntheticWindow(const std::vector<EdgeCrossing>& bursts, CircleShade shade = CircleShade::Dark)
      : window(BoardScene({.circles = shade, .given_m = {}}, kDavis_px, std::nullopt)) {
    window.assign(bursts, 0);
  }
  SyntheticWindow(const SyntheticWindow&) = delete;
};

// A board in front of a pinhole camera (focal length 260 px) that moves with constant rates.
struct MovingBoard {
  Board board = {BoardType::AsymmetricCircles, 11, 4, 0.03, 0.012, CircleShade::Dark, 0.0, {}};
  Eigen::Vector3d angles_rad = {0.2, -0.3, 0.1}, angular_rates_rad_s = {0.2, -0.1, 0.3};
  Eigen::Vector3d middle_m = {0.0, 0.0, 0.5}, velocity_m_s = {0.15, 0.08, 0.1};

  Eigen::Matrix3d homographyAt(double time_s) const {
    const Eigen::Vector3d a = angles_rad + time_s * angular_rates_rad_s;
    const Eigen::Matrix3d rotation = (Eigen::AngleAxisd(a.x(), Eigen::Vector3d::UnitX()) *
                                      Eigen::AngleAxisd(a.y(), Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(a.z(), Eigen::Vector3d::UnitZ()))
                                         .toRotationMatrix();
    const Eigen::Vector2d half = 0.5 * (board.point_m(0) + board.point_m(board.pointCount() - 1));
    const Eigen::Vector3d origin = middle_m + time_s * velocity_m_s - rotation.leftCols<2>() * half;
    Eigen::Matrix3d h;
    h << rotation.col(0), rotation.col(1), origin;
    Eigen::Matrix3d k = Eigen::Matrix3d::Identity();
    k.diagonal().head<2>().setConstant(260.0);
    k.topRightCorner<2, 1>() << 172.5, 129.5;
    h = k * h;
    return h / h(2, 2);
  }

  BoardScene scene() const { return {board, kDavis_px, std::nullopt}; }

  OutlineImage imageAt(int circle, double time_s) const {
    return *imageOfCircle(homographyAt(time_s), scene(), circle);
  }
  Eigen::Vector2d velocityAt(int circle, double time_s) const {
    constexpr double kStep_s = 1e-4;
    return (imageAt(circle, time_s + kStep_s).centre_px - imageAt(circle, time_s - kStep_s).centre_px) /
           (2.0 * kStep_s);
  }

  // The true homography, and a velocity field fitted to the circles' true velocities.
  BoardMotion motionAt(double time_s) const {
    BoardMotion motion;
    motion.time_ns = static_cast<std::int64_t>(std::llround(time_s * 1e9));
    motion.ideal_from_board = homographyAt(time_s);
    motion.frame = {{172.5, 129.5}, 100.0};
    Eigen::MatrixXd rows(2 * board.pointCount(), 8);
    Eigen::VectorXd velocities(2 * board.pointCount());
    for (int i = 0; i < board.pointCount(); ++i) {
      rows.middleRows<2>(2 * i) = motion.frame.basis(imageAt(i, time_s).centre_px);
      velocities.segment<2>(2 * i) = velocityAt(i, time_s);
    }
    motion.velocity_px_s = (rows.transpose() * rows).ldlt().solve(rows.transpose() * velocities);
    return motion;
  }
};

// All bursts of the board's circles within half_window_s of time 0, from the true motion, without a flow
// model.
inline std::vector<EdgeCrossing> burstsOf(const MovingBoard& moving, double half_window_s, double noise_px,
                                          std::mt19937& random) {
  constexpr int kSteps = 60;
  std::normal_distribution<double> normal;
  std::vector<EdgeCrossing> bursts;
  for (int i = 0; i < moving.board.pointCount(); ++i) {
    std::vector<OutlineImage> images;
    for (int k = 0; k <= kSteps; ++k)
      images.push_back(moving.imageAt(i, half_window_s * (2.0 * k / kSteps - 1.0)));
    const Eigen::Vector2d velocity = moving.velocityAt(i, 0.0);
    const OutlineImage& middle = images[kSteps / 2];
    const double reach = middle.max_radius_px + velocity.norm() * half_window_s + 2.0;
    for (int y = static_cast<int>(middle.centre_px.y() - reach); y <= middle.centre_px.y() + reach; ++y) {
      for (int x = static_cast<int>(middle.centre_px.x() - reach); x <= middle.centre_px.x() + reach; ++x) {
        if (x < 0 || y < 0 || x >= kDavis_px.width_px || y >= kDavis_px.height_px) continue;
        const Eigen::Vector2d pixel(x, y);
        for (int k = 0; k < kSteps; ++k) {
          const double before = distanceToEdge(images[static_cast<std::size_t>(k)], pixel).distance_px;
          const double after = distanceToEdge(images[static_cast<std::size_t>(k + 1)], pixel).distance_px;
          if ((before < 0.0) == (after < 0.0)) continue;
          double low_s = half_window_s * (2.0 * k / kSteps - 1.0),
                 high_s = low_s + half_window_s * 2.0 / kSteps;
          for (int bisection = 0; bisection < 30; ++bisection) {
            const double half_s = 0.5 * (low_s + high_s);
            const double here = distanceToEdge(moving.imageAt(i, half_s), pixel).distance_px;
            ((here < 0.0) == (before < 0.0) ? low_s : high_s) = half_s;
          }
          const double normal_speed = std::abs(after - before) * kSteps / (2.0 * half_window_s);
          const double time_s = low_s + noise_px * normal(random) / std::max(normal_speed, 1.0);
          const bool leading = before > 0.0;
          bursts.push_back(burstAt(x, y, time_s, leading != (moving.board.circles == CircleShade::Dark)));
        }
      }
    }
  }
  return bursts;
}

}  // namespace evical::test
