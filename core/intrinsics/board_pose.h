// The board's pose in one view, from its circles' centres and a camera model.
#pragma once

#include "core/geometry/board.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/rigid_transform.h"
#include "core/intrinsics/sensor_views.h"

#include <optional>

namespace evical {

// camera_from_board; nothing where the circles make no pose. Of a plane's two poses the one that fits better.
std::optional<RigidTransform> boardPose(const SensorView& view, const Board& board,
                                        const CameraIntrinsics& camera);

}  // namespace evical
