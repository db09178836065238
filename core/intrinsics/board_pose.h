// Pose of the board in one view, from its circles' centres and a camera model.
#pragma once

#include "core/geometry/board.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/rigid_transform.h"
#include "core/intrinsics/sensor_views.h"

#include <optional>

namespace evical {

// camera_from_board; empty if the circles do not determine a pose. The better-fitting one of a plane's two
// poses.
std::optional<RigidTransform> boardPose(const SensorView& view, const Board& board,
                                        const CameraIntrinsics& camera);

}  // namespace evical
