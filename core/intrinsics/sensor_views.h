// Board views in the sensor's own pixels, whatever camera model the front end saw them with. Each circle of a
// view is brought to the view's one time with its own velocity.
#pragma once

#include "core/data/board_observations.h"
#include "core/geometry/board.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/intrinsics/intrinsics_options.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace evical {

struct SensorCircle {
  Eigen::Vector2d on_board_m = Eigen::Vector2d::Zero();
  // Where the centre of the ellipse, which is one in ideal pixels only, lies on the sensor.
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Identity();
  Eigen::Vector2d lead_effect = Eigen::Vector2d::Zero();  // px for each pixel of edge lead
  bool used = true;
};

struct SensorView {
  double time_s = 0.0;
  std::vector<SensorCircle> circles;
};

// `detection_intrinsics`: the camera whose ideal pixels the observations are in; none: they are the sensor's. Views with
// fewer circles than options.least_circles are left out.
std::vector<SensorView> sensorViews(const BoardObservations& observations, const Board& board,
                                    const std::optional<CameraIntrinsics>& detection_intrinsics,
                                    const IntrinsicsOptions& options);

}  // namespace evical
