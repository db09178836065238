// Selection of the most informative views of a recording: spread over the image and over the board's tilt.
#pragma once

#include "core/intrinsics/sensor_views.h"

#include "core/geometry/camera_intrinsics.h"

#include <vector>

namespace evical {

// At most options.most_views of them, in time order; deterministic. Tilts are computed with `camera`, which
// may be approximate.
std::vector<SensorView> selectViews(const std::vector<SensorView>& views, const Board& board,
                                    const CameraIntrinsics& camera, const IntrinsicsOptions& options);

}  // namespace evical
