// Which views of a recording say most about the camera: spread over the image and over the board's tilt.
#pragma once

#include "core/intrinsics/sensor_views.h"

#include "core/geometry/camera_intrinsics.h"

#include <vector>

namespace evical {

// Up to options.most_views of them, in time order; the same for the same views. Tilts are seen with `camera`,
// a rough one will do.
std::vector<SensorView> selectViews(const std::vector<SensorView>& views, const Board& board,
                                    const CameraIntrinsics& camera, const IntrinsicsOptions& options);

}  // namespace evical
