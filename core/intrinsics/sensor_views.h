// Board views in the sensor's own pixels, independent of the front end's camera model. Each circle of a
// view is moved to the view's time with its own velocity.
#pragma once

#include "core/intrinsics/intrinsics_options.h"

#include "core/data/board_observations.h"
#include "core/geometry/board.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/so3.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace evical {

struct SensorCircle {
  Eigen::Vector2d on_board_m = Eigen::Vector2d::Zero();
  // Position on the sensor of the centre of the ellipse, which is an ellipse in ideal pixels only.
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Identity();
  std::optional<Eigen::Vector2d> only_known = {};         // onlyKnownDirection
  Eigen::Vector2d lead_effect = Eigen::Vector2d::Zero();  // px per pixel of edge localisation bias
  bool used = true;
};

struct SensorView {
  double time_s = 0.0;
  std::vector<SensorCircle> circles;
};

// `detection_intrinsics`: the camera whose ideal pixels the observations are in; none: they are the sensor's.
// Views with fewer circles than options.min_circles are excluded.
std::vector<SensorView> sensorViews(const BoardObservations& observations, const Board& board,
                                    const std::optional<CameraIntrinsics>& detection_intrinsics,
                                    const IntrinsicsOptions& options);

// Pose of the board in one view, from its circles' centres and a camera model.

// camera_from_board; empty if the circles do not determine a pose. The better-fitting one of a plane's two
// poses.
std::optional<RigidTransform> boardPose(const SensorView& view, const Board& board,
                                        const CameraIntrinsics& camera);

}  // namespace evical
