// Start values of the bundle adjustment.
#pragma once

#include "core/intrinsics/sensor_views.h"

#include "core/geometry/board.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/resolution.h"

#include <optional>
#include <vector>

namespace evical {

// The camera of this model that is closest to `camera`: both project rays through the image to nearly the
// same pixels.
CameraIntrinsics sameLens(const CameraIntrinsics& camera, CameraModel model);

// A double sphere has two similar solutions, with xi below and above 0. The views determine which one is
// correct, but no optimiser step leads from one to the other: this function does.
CameraIntrinsics otherSide(const CameraIntrinsics& sphere);

// Starts of the optimisation, at least one: the front end's lens and, if that is missing or a guess, OpenCV's
// calibration of centres as points. For all models except radial-tangential, lenses with fields of view from
// 100 to 200 degrees are added, and the two with the smallest errors remain.
std::vector<CameraIntrinsics> intrinsicsStarts(const std::vector<SensorView>& views, const Board& board,
                                               CameraModel model, Resolution resolution_px,
                                               const std::optional<CameraIntrinsics>& detection_intrinsics);

// A camera that shows the boards' tilts: radial-tangential, or double sphere if that fits clearly better.
CameraIntrinsics roughStart(const std::vector<SensorView>& views, const Board& board,
                            Resolution resolution_px,
                            const std::optional<CameraIntrinsics>& detection_intrinsics);

// Selection of the most informative views of a recording: spread over the image and over the board's tilt.

// At most options.max_views of them, in time order; deterministic. Tilts are computed with `camera`, which
// may be approximate.
std::vector<SensorView> selectViews(const std::vector<SensorView>& views, const Board& board,
                                    const CameraIntrinsics& camera, const IntrinsicsOptions& options);

}  // namespace evical
