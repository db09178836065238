// What an edge lead does to a measured ellipse centre. Which way and how far the centre moves for each
// pixel of lead, the measurement itself says: that depends on the ellipse's shape, on which of its arcs
// fired, and on the lens. The lead of real pixels is not quite the same at every speed: it may grow with
// the logarithm of the speed, around 100 px/s on the sensor, and fades out near standstill, where edges
// turn back within a burst.
#pragma once

#include "core/data/board_observations.h"
#include "core/data/calibration_state.h"
#include "core/geometry/camera_model.h"

#include <Eigen/LU>

#include <cmath>

namespace evical {

struct EdgeLeadEffect {
  Eigen::Vector2d of_lead, of_growth;  // px per px
};

// A camera's lead at 100 px/s, and its growth.
struct EdgeLead {
  double lead_px, growth_px;

  Eigen::Vector2d times(const EdgeLeadEffect& effect) const {
    return lead_px * effect.of_lead + growth_px * effect.of_growth;
  }
};
inline EdgeLead edgeLeadOf(const CameraState& camera) {
  return {camera.edge_lead_px, camera.edge_lead_growth_px};
}

inline EdgeLeadEffect edgeLeadEffect(const CameraIntrinsics& camera, const CircleObservation& circle,
                                     double rest_speed_px_s) {
  constexpr double kReferenceSpeed_px_s = 100.0;
  const Eigen::Matrix2d stretch = idealPixelScale(camera, circle.centre_px);
  const double speed_px_s = (stretch.inverse() * circle.velocity_px_s).norm();
  const double with_rest_px_s = std::hypot(speed_px_s, rest_speed_px_s);
  const Eigen::Vector2d effect = speed_px_s / with_rest_px_s * circle.edge_lead_effect;
  return {effect, std::log(with_rest_px_s / kReferenceSpeed_px_s) * effect};
}

}  // namespace evical
