// Poses of further boards, and of the cameras that see them.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/initialisation/camera_poses.h"
#include "core/initialisation/initialise.h"
#include "core/initialisation/world_rotation.h"

#include <Eigen/Geometry>

#include <map>
#include <optional>
#include <span>
#include <vector>

namespace evical {

// `aligned`: by camera; those that see the world's board are ignored. `body`: the reference's motion in the
// world, known within `gap_s` of its view times. Sets the boards and their cameras in result.state. Throws
// CalibrationFailed if a board is never seen at the same time as the world's.
void alignFurtherBoards(const CalibrationInput& input, const std::map<std::size_t, AlignedCamera>& aligned,
                        const CameraTrajectory& body, double gap_s, const InitialisationOptions& options,
                        Initialisation& result);

// Pose of a further board in the world, and of its cameras on the body (docs/maths.md, 8.12). The body's
// pose is known from other cameras' views of the world's board, and at those times
//   world_from_body(t) body_from_camera = world_from_board board_from_camera(t),
// with the rotation of body_from_camera known from hand-eye calibration. Both translations follow from one
// linear system: the body must rotate about two axes.

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
  int views = 0;          // number of views used
  double agreeing = 0.0;  // share of consistent views, relative to the scatter of the better ones
  double rotation_rms_rad = 0.0, position_rms_m = 0.0;  // robust
};

// From views within `gap_s` of known poses of the body; empty if there are fewer than `min_views`.
// `scale`: of the board; -1 if the images of its cameras or those of the body's are mirrored (8.13).
std::optional<BoardAlignment> alignBoard(const CameraTrajectory& body, std::span<const BoardSight> sights,
                                         double gap_s, int min_views, double scale = 1.0);

}  // namespace evical
