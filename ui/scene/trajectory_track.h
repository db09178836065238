// SPDX-License-Identifier: GPL-3.0-or-later
// A trajectory as it is drawn: sampled from the splines once, off the GUI thread. No VTK, no widgets.
#pragma once

#include "core/data/calibration_result.h"
#include "core/geometry/trajectory.h"

#include <Eigen/Core>

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
  std::vector<double> residuals_px;  // of the nearest board view, RMS; NaN where there is none near
  std::vector<CameraStation> stations;

  bool empty() const { return times_s.empty(); }
  bool hasResiduals() const;
  std::size_t nearest(double time_s) const;  // index; the track is not empty
};

// Nothing in it where the state has no splines yet.
TrajectoryTrack sampleTrajectory(const CalibrationState& state, std::span<const CircleResidual> residuals);

// A line a sample: time, position, speed and, where there are any, residuals.
std::string trackCsv(const TrajectoryTrack& track);

// The first camera's time of a time of the splines.
double firstCameraTime_s(const CalibrationState& state, double time_s);
bool hasTrajectory(const CalibrationState& state);

// The instant at the cursor.
struct RigInstant {
  MotionSample imu;
  std::vector<RigidTransform> world_from_cameras, world_from_imus;  // the reference among the latter
};
// Nothing where the splines do not reach.
std::optional<RigInstant> rigAt(const CalibrationState& state, double camera_time_s);

// Round numbers for intervals, scales and grids: 1, 2 or 5 times a power of ten, `value` or the next above.
double roundedUp(double value);

}  // namespace evical::ui
