// Where the bundle adjustment starts.
#pragma once

#include "core/geometry/board.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/resolution.h"
#include "core/intrinsics/sensor_views.h"

#include <optional>
#include <vector>

namespace evical {

// The camera of this model that sees nearly what `camera` sees: both project rays through the image nearly to
// the same pixels.
CameraIntrinsics sameLens(const CameraIntrinsics& camera, CameraModel model);

// A double sphere has two solutions that are much alike, one with xi below 0 and one above. Which of them is right the
// views tell, but no step leads from one to the other: this does.
CameraIntrinsics otherSide(const CameraIntrinsics& sphere);

// At least one: the lens that the front end saw with, and where that was a guess, one without distortion
// coefficients, also OpenCV's calibration on the centres as if they were points. Of the wide models the two nearest of
// these and of a few lenses from 100 to 200 degrees across.
std::vector<CameraIntrinsics> intrinsicsStarts(const std::vector<SensorView>& views, const Board& board,
                                               CameraModel model, Resolution resolution_px,
                                               const std::optional<CameraIntrinsics>& detection_intrinsics);

// One that shows where the boards were: radial-tangential, or double sphere where that sees them clearly better.
CameraIntrinsics roughStart(const std::vector<SensorView>& views, const Board& board,
                            Resolution resolution_px,
                            const std::optional<CameraIntrinsics>& detection_intrinsics);

}  // namespace evical
