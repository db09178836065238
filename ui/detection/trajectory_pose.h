// SPDX-License-Identifier: GPL-3.0-or-later
// Camera poses from a calibration's trajectory.
#pragma once

#include "core/data/calibration_state.h"

#include <optional>

namespace evical::ui {

// At a time of the camera's own clock; none outside the trajectory.
std::optional<RigidTransform> cameraFromWorldAt(const CalibrationState& state, const CameraState& camera,
                                                double camera_time_s);

// Exposure time of row `y_px` in a rolling-shutter frame with stamp `frame_time_s`, on the camera's own
// clock; needs a lens.
double rowTime_s(const CameraState& camera, double frame_time_s, double y_px);

// Time on one camera's clock that corresponds to this time on another's.
double timeOnClockOf_s(const CameraState& other, const CameraState& camera, double camera_time_s);

}  // namespace evical::ui
