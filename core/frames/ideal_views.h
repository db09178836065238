// Conversion of views from the sensor's own pixels to ideal pixels (camera_model.h) with a known lens.
//
// Through a lens, the image of a circle is not exactly an ellipse, and the centre of the best-fitting ellipse
// is not the projection of the undistorted ellipse's centre: near the corners of a wide lens's picture the
// difference is 0.2 px for a circle of 25 px. Therefore the ellipse's edge is undistorted, and fitted again.
#pragma once

#include "core/data/board_observations.h"
#include "core/geometry/camera_intrinsics.h"

#include <optional>

namespace evical {

// Empty if the place is not visible through the lens.
std::optional<CircleObservation> inIdealPixels(const CircleObservation& of_sensor,
                                               const CameraIntrinsics& camera);

// All views; points outside the lens's view are excluded.
BoardObservations inIdealPixels(const BoardObservations& of_sensor, const CameraIntrinsics& camera);

// The same if the lens is known, else in the sensor's pixels; in both cases with the points' rows on a sensor
// of this height.
BoardObservations throughLens(BoardObservations of_sensor, int height_px,
                              const std::optional<CameraIntrinsics>& lens);

}  // namespace evical
