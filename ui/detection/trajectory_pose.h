// SPDX-License-Identifier: GPL-3.0-or-later
// Where a calibration's trajectory puts a camera.
#pragma once

#include "core/data/calibration_state.h"

#include <optional>

namespace evical::ui {

// At a time of the camera's own clock; nothing outside the trajectory.
std::optional<RigidTransform> cameraFromWorldAt(const CalibrationState& state, const CameraState& camera,
                                                double camera_time_s);

// When a frame of a rolling shutter that is stamped `frame_time_s` had its row `y_px` exposed, on the camera's own clock;
// needs a lens.
double rowTime_s(const CameraState& camera, double frame_time_s, double y_px);

// When one camera's clock shows this time, what another's shows.
double timeOnClockOf_s(const CameraState& other, const CameraState& camera, double camera_time_s);

}  // namespace evical::ui
