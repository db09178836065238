// Where the bundle adjustment starts.
#pragma once

#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/circle_board.h"
#include "core/geometry/resolution.h"
#include "core/intrinsics/sensor_views.h"

#include <optional>
#include <vector>

namespace evical {

// The camera of this model that sees nearly what `camera` sees: both project rays through the image nearly to
// the same pixels.
CameraIntrinsics sameLens(const CameraIntrinsics& camera, CameraModel model);

// At least one: the lens that the front end saw with, and where that was a guess, one without distortion
// coefficients, also OpenCV's calibration on the centres as if they were points.
std::vector<CameraIntrinsics> intrinsicsStarts(const std::vector<SensorView>& views, CameraModel model,
                                               Resolution resolution_px,
                                               const std::optional<CameraIntrinsics>& seen_with);

}  // namespace evical
