// Effect of an edge localisation bias on a measured ellipse centre. The measurement gives the centre's shift
// per pixel of bias, which depends on the ellipse's shape, on the arcs that fired, and on the lens. The bias
// is one length at all but the lowest speeds: slow edges, which reverse and whose bursts are joined by noise,
// are seen slightly further behind (docs/maths.md, 9.1).
#pragma once

#include "core/data/board_observations.h"
#include "core/data/calibration_state.h"
#include "core/geometry/camera_model.h"

#include <Eigen/LU>

#include <cmath>

namespace evical {

struct EdgeLocalisationBiasEffect {
  Eigen::Vector2d of_lead, of_slow;  // px per px
};

// A camera's lead, and the additional lead of edges that hardly move.
struct EdgeLocalisationBias {
  double lead_px, slow_px;

  Eigen::Vector2d times(const EdgeLocalisationBiasEffect& effect) const {
    return lead_px * effect.of_lead + slow_px * effect.of_slow;
  }
};
inline EdgeLocalisationBias edgeBiasOf(const CameraState& camera) {
  return {camera.edge_localisation_bias_px, camera.slow_edge_localisation_bias_px};
}

inline EdgeLocalisationBiasEffect edgeBiasEffect(const CameraIntrinsics& camera,
                                                 const CircleObservation& circle,
                                                 double slow_edge_speed_px_s) {
  if (circle.edge_localisation_bias_effect.isZero(0.0))
    return {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  const Eigen::Matrix2d stretch = idealPixelScale(camera, circle.centre_px);
  const double speed_px_s = (stretch.inverse() * circle.velocity_px_s).norm();
  return {circle.edge_localisation_bias_effect,
          std::exp(-speed_px_s / slow_edge_speed_px_s) * circle.edge_localisation_bias_effect};
}

}  // namespace evical
