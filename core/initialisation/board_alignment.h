// Place of a further board in the world, and of its cameras on the body (docs/maths.md, 8.12). The body's
// place is known from other cameras' views of the world's board, and at those moments
//   world_from_body(t) body_from_camera = world_from_board board_from_camera(t),
// with the rotation of body_from_camera known by hand-eye. Both translations follow from one linear system:
// the body must rotate about two axes.
#pragma once

#include "core/data/calibration_priors.h"
#include "core/initialisation/camera_trajectory.h"

#include <Eigen/Geometry>

#include <optional>
#include <span>
#include <vector>

namespace evical {

// One camera that sees the board.
struct BoardSight {
  std::span<const CameraPose> poses;  // board_from_camera; camera time
  double time_offset_s = 0.0;         // body_time = camera_time + time_offset_s
  Eigen::Quaterniond body_from_camera = Eigen::Quaterniond::Identity();
  std::optional<KnownVector> translation = {};  // of body_from_camera
};

struct BoardAlignment {
  RigidTransform world_from_board;
  std::vector<Eigen::Vector3d> cameras_in_body_m;
  int views = 0;          // that determine it
  double agreeing = 0.0;  // share of them near where the others put it, by how the better ones scatter
  double rotation_rms_rad = 0.0, position_rms_m = 0.0;  // robust
};

// From views within `gap_s` of the body's known places; nothing if fewer than `least_views`.
std::optional<BoardAlignment> alignBoard(const CameraTrajectory& body, std::span<const BoardSight> sights,
                                         double gap_s, int least_views);

}  // namespace evical
