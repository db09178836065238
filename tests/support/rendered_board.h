// Images of boards with a known truth: every pixel is the mean of the pattern over its area.
#pragma once

#include "core/frames/gray_image.h"
#include "core/frames/plane_map.h"
#include "core/geometry/board.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/so3.h"
#include "core/geometry/tag_layout.h"

#include <functional>
#include <optional>
#include <vector>

namespace evical {

// Properties of a board that its parameters do not determine.
struct PrintedBoard {
  Board board;
  int border_bits = 2;           // AprilGrid
  int dictionary = 0;            // ChArUco: OpenCV's index
  bool first_is_bright = false;  // ChArUco
  int clockwise_turns = 0;       // quarter turns of tags and markers within their squares
  TagOrder order = TagOrder::RowsUp;
  int first_tag = 0;      // its number
  bool mirrored = false;  // the whole print, in x
};

struct Exposure {
  double dark = 40.0, bright = 210.0;
  double blur_px = 0.7;  // sigma
  double noise = 3.0;    // sigma
  unsigned seed = 1;
};

// 752 x 480 pixels, and a lens with distortion.
CameraIntrinsics distortingCamera();

// Brightness of the board's plane, 0 to 1.
std::function<double(const Eigen::Vector2d&)> patternOf(const PrintedBoard& printed);

GrayImage renderBoard(const PrintedBoard& printed, const CameraIntrinsics& camera,
                      const RigidTransform& camera_from_board, const Exposure& exposure);

// Image of a point; for a circle, the image of its ellipse's centre. Empty behind the camera.
std::optional<Eigen::Vector2d> truePoint(const Board& board, int point, const CameraIntrinsics& camera,
                                         const RigidTransform& camera_from_board);

// Boards that look the same upside down may start at either end: points by their true indices.
FoundPoints asTrue(FoundPoints points, const Board& board, const CameraIntrinsics& camera,
                   const RigidTransform& camera_from_board);

// The camera's view of the board's centre from a distance, rotated by the rotation vector about it.
RigidTransform lookAt(const Board& board, double distance_m, const Eigen::Vector3d& turn_rad,
                      const Eigen::Vector2d& beside_m = Eigen::Vector2d::Zero());

}  // namespace evical
