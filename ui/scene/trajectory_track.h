// SPDX-License-Identifier: GPL-3.0-or-later
// Trajectory for drawing: sampled from the splines once, outside the GUI thread. Without VTK and widgets.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/event.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/trajectory.h"

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace evical::ui {

struct CameraStation {
  double time_s = 0.0;
  std::vector<RigidTransform> world_from_cameras;
};

// Times are seconds since the recording's start on the first camera's clock.
struct TrajectoryTrack {
  std::vector<double> times_s;
  std::vector<Eigen::Vector3d> positions_m;  // of the reference IMU in the world
  std::vector<double> speeds_m_s;
  std::vector<double> residuals_px;  // RMS of the nearest board view; NaN if none is near
  std::vector<CameraStation> stations;

  bool empty() const { return times_s.empty(); }
  bool hasResiduals() const;
  std::size_t nearest(double time_s) const;  // index; the track is not empty
};

// Empty if the state has no splines yet.
TrajectoryTrack sampleTrajectory(const CalibrationState& state, std::span<const CircleResidual> residuals);

// One line per sample: time, position, speed and, if available, residuals.
std::string trackCsv(const TrajectoryTrack& track);

// Time on the first camera's clock of a time of the splines.
double firstCameraTime_s(const CalibrationState& state, double time_s);
bool hasTrajectory(const CalibrationState& state);

// Poses at the cursor's time.
struct RigInstant {
  MotionSample imu;
  std::vector<RigidTransform> world_from_cameras, world_from_imus;  // the reference among the latter
};
// None outside the splines.
std::optional<RigInstant> rigAt(const CalibrationState& state, double camera_time_s);

// Smallest number of 1, 2 or 5 times a power of ten that is at least `value`; for intervals, scales and
// grids.
double roundedUp(double value);

// Events around the cursor's time on the image plane of the camera's frustum.

// Access to a camera's events by time, usable in another thread.
struct EventLookup {
  std::size_t camera = 0;
  std::function<std::vector<Event>(double begin_s, double end_s)> between = {};  // none: no events
};

struct FrustumEvent {
  Eigen::Vector3d at;  // in the camera frame, at z = 1
  bool brighter = false;
};

struct FrustumEvents {
  std::size_t camera = 0;
  std::vector<FrustumEvent> events;
};

// The newest event of each pixel; thinned out if there are very many, to keep the frame rate. Empty without a
// lens.
std::vector<FrustumEvent> onImagePlane(const std::vector<Event>& events,
                                       const std::optional<CameraIntrinsics>& intrinsics);

}  // namespace evical::ui
