// Joint motion model of all circles in a window: the board's homography at the window's middle, the velocity
// field of its image, and the distance of burst medians outside or inside the true edges. Fitted directly to
// the bursts.
#pragma once

#include "core/frontend/board_outline.h"
#include "core/frontend/board_scene.h"
#include "core/frontend/burst_window.h"
#include "core/frontend/detection_options.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace evical {

// Field of a plane's image motion, in px or px/s over the image: with x, y = (pixel - centre) / scale,
//   (f0 + f1 x + f2 y + x (f6 x + f7 y),  f3 + f4 x + f5 y + y (f6 x + f7 y)).
using PlaneFlow = Eigen::Matrix<double, 8, 1>;
using PlaneFlowBasis = Eigen::Matrix<double, 2, 8>;

struct ImageFrame {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  double scale_px = 1.0;

  PlaneFlowBasis basis(const Eigen::Vector2d& pixel) const;
  Eigen::Vector2d flow(const PlaneFlow& coefficients, const Eigen::Vector2d& pixel) const;
  Eigen::Matrix2d gradient(const PlaneFlow& coefficients,
                           const Eigen::Vector2d& pixel) const;  // of flow, per px
};

struct BoardMotion {
  std::int64_t time_ns = 0;
  Eigen::Matrix3d ideal_from_board =
      Eigen::Matrix3d::Identity();  // homography: metres on the board to ideal pixels
  ImageFrame frame;
  PlaneFlow velocity_px_s = PlaneFlow::Zero();
  PlaneFlow acceleration_px_s2 = PlaneFlow::Zero();
  double radius_offset_px = 0.0;  // of burst medians outside the edges, in pixels
  double typical_events = 0.0;    // of a burst at an edge that moves along its normal; 0: unknown
  double residual_rms_px = 0.0;
  int bursts = 0;

  Eigen::Vector2d velocityAt(const Eigen::Vector2d& ideal_pixel) const {
    return frame.flow(velocity_px_s, ideal_pixel);
  }
  Eigen::Vector2d accelerationAt(const Eigen::Vector2d& ideal_pixel) const {
    return frame.flow(acceleration_px_s2, ideal_pixel);
  }
  // Motion of a point of the board's image from the window's middle to `after_s` later.
  Eigen::Vector2d travel(const Eigen::Vector2d& ideal_pixel, double after_s) const {
    return frame.flow(after_s * (velocity_px_s + 0.5 * after_s * acceleration_px_s2), ideal_pixel);
  }
};

// The board's motion extrapolated to another time.
BoardMotion predicted(const BoardMotion& motion, std::int64_t time_ns);

// Homography after a small plane flow: H <- (I + E) H.
Eigen::Matrix3d warped(const Eigen::Matrix3d& ideal_from_board, const ImageFrame& frame,
                       const PlaneFlow& shift_px);

// Mean speed of the board's circles in the image, in the sensor's pixels.
double boardSpeed_px_s(const BoardMotion& motion, const BoardScene& scene);

// Circles in the image that move enough within a window of this half width to fire events.
std::vector<int> circlesExpected(const BoardMotion& motion, const BoardScene& scene, double half_window_s);
inline int expectedCircles(const BoardMotion& motion, const BoardScene& scene, double half_window_s) {
  return static_cast<int>(circlesExpected(motion, scene, half_window_s).size());
}

// Half width of the window of fitted bursts at that speed.
double fitHalfWindow_s(double speed_px_s, const TrackingOptions& options);

// Weight of a burst by the direction in which its edge crossed the pixel: if an edge only grazes a pixel, its
// burst is short and too early. `leads` is the cosine between outward normal and motion, negative if
// the polarity contradicts it.
inline double crossingWeight(double leads, double events, double typical_events,
                             const TrackingOptions& options) {
  const auto ramp = [](double value, double zero, double one) {
    return value <= zero ? 0.0 : (value >= one ? 1.0 : (value - zero) / (one - zero));
  };
  const double weight = ramp(leads, options.min_polarity_cosine, options.full_polarity_cosine);
  if (typical_events <= 0.0) return weight;
  return weight * ramp(events / typical_events, options.min_event_part, options.full_event_part);
}

// Sign of the leads of bursts that can have a weight at a straight edge that moves so; 0 if none can: it
// moves along itself. NaN if any can: at a round outline, or if the motion is too slow or hardly across.
// `turns` is the uncertainty of the cosine between normal and motion.
inline double usefulLead(const OutlineImage& outline, const Eigen::Vector2d& velocity_px_s, double turns,
                         const TrackingOptions& options) {
  constexpr double kSlow_px_s = 15.0;
  const double speed_px_s = velocity_px_s.norm();
  if (!outline.isStraight() || speed_px_s < kSlow_px_s) return NAN;
  const double cosine = outline.normal.dot(velocity_px_s) / speed_px_s;
  if (std::abs(cosine) + turns < options.min_polarity_cosine) return 0.0;
  return std::abs(cosine) < turns ? NAN : std::copysign(1.0, cosine);
}

// Fits homography, velocity field and radius offset to the bursts of a window whose middle is start.time_ns.
// `first_gate_px` as in the options, or wider after a search. Empty if too few bursts are near the edges.
std::optional<BoardMotion> fitBoardMotion(const BurstWindow& window, const BoardMotion& start,
                                          const BoardScene& scene, double first_gate_px,
                                          const TrackingOptions& options);

// A board's motion from a few of its points, if no better estimate is available: for the circles of a search,
// or the centres of an earlier view.

// In ideal pixels.
struct MovingPoint {
  Eigen::Vector2d centre_px, velocity_px_s;
};

// The plane flow that fits the velocities; terms that a few points do not determine are regularised towards
// zero.
PlaneFlow fitPlaneFlow(const ImageFrame& frame, const std::vector<MovingPoint>& points);

// The homography, with a frame around the points and their flow.
BoardMotion motionFromPoints(const Eigen::Matrix3d& ideal_from_board, const std::vector<MovingPoint>& points,
                             std::int64_t time_ns);

}  // namespace evical
