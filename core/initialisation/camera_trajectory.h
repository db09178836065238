// The reference camera's own motion, if there is no IMU: splines through its poses, equivalent gyroscope
// samples, and the other cameras' poses relative to it.
#pragma once

#include "core/data/imu_sample.h"
#include "core/geometry/so3_spline.h"
#include "core/geometry/vector_spline.h"
#include "core/initialisation/camera_poses.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace evical {

// For views with two possible poses, selects the one closer to those of its neighbours in time. Returns the
// number of swapped ones.
int resolveBySmoothness(std::vector<CameraPose>& poses, double max_pair_s);

struct CameraTrajectory {
  So3Spline world_from_camera_rotation;
  VectorSpline camera_in_world_m;
  std::vector<double> view_times_s;  // ascending: times of the views

  // True with a view within `gap_s` before and after.
  bool isKnownAt(double time_s, double gap_s) const;
};
CameraTrajectory trajectoryThrough(const std::vector<CameraPose>& poses, double begin_s, double end_s,
                                   double knot_spacing_s);

// Angular rates as samples, 200 Hz, on the camera's clock.
std::vector<ImuSample> angularRatesOf(const CameraTrajectory& trajectory, std::int64_t start_ns);

struct RelativePose {
  MeanPose reference_from_camera;
  int views = 0;  // number of views used
};
// From views at times when the reference's pose is known, too; empty if there are fewer than `min_views`.
std::optional<RelativePose> relativePose(const CameraTrajectory& reference,
                                         const std::vector<CameraPose>& poses, double time_offset_s,
                                         double gap_s, int min_views);

}  // namespace evical
