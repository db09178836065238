// Along which way a measured ellipse centre is shifted, in ideal pixels, per pixel of edge lead. The lead is
// a property of the sensor: it has one length in the sensor's pixels, not in ideal ones, which lens
// distortion stretches.
//   J v_s / sqrt(|v_s|^2 + v_rest^2),  v_s = J^-1 v,  J = d(ideal pixel)/d(pixel)
#pragma once

#include "core/geometry/camera_model.h"

#include <Eigen/LU>

#include <cmath>

namespace evical {

inline Eigen::Vector2d edgeLeadDirection(const CameraIntrinsics& camera, const Eigen::Vector2d& ideal_pixel,
                                         const Eigen::Vector2d& ideal_velocity_px_s, double rest_speed_px_s) {
  const Eigen::Matrix2d scale = idealPixelScale(camera, ideal_pixel);
  const Eigen::Vector2d sensor_velocity = scale.inverse() * ideal_velocity_px_s;
  return ideal_velocity_px_s / std::hypot(sensor_velocity.norm(), rest_speed_px_s);
}

}  // namespace evical
