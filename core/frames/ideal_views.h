// Views of the sensor's own pixels in ideal pixels (camera_model.h), once a lens is known.
//
// What a lens makes of a circle is not quite an ellipse, and the centre of the ellipse that fits it best is not
// where the lens puts the centre of the undistorted one: near the corners of a picture by a wide lens that is
// 0.2 px for a circle of 25 px. So it is the ellipse's edge that is undistorted, and fitted anew.
#pragma once

#include "core/data/board_observations.h"
#include "core/geometry/camera_intrinsics.h"

#include <optional>

namespace evical {

// Nothing where the lens sees no such place.
std::optional<CircleObservation> inIdealPixels(const CircleObservation& of_sensor,
                                               const CameraIntrinsics& camera);

// All views; points that the lens does not see are left out.
BoardObservations inIdealPixels(const BoardObservations& of_sensor, const CameraIntrinsics& camera);

// The same where the lens is known, and in the sensor's pixels where it is not; either way with the rows of a sensor
// of this height in which the points were seen.
BoardObservations throughLens(BoardObservations of_sensor, int height_px,
                              const std::optional<CameraIntrinsics>& lens);

}  // namespace evical
