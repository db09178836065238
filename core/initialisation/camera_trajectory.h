// The reference camera's own motion, where there is no IMU: splines through its poses, what a gyroscope on it
// would measure, and how the other cameras sit on it.
#pragma once

#include "core/data/imu_sample.h"
#include "core/geometry/so3_spline.h"
#include "core/geometry/vector_spline.h"
#include "core/initialisation/camera_poses.h"
#include "core/initialisation/mean_pose.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace evical {

// If a view allows two poses, takes the one nearer to those of its neighbours in time. Returns the number of
// swapped ones.
int resolveBySmoothness(std::vector<CameraPose>& poses, double longest_pair_s);

struct CameraTrajectory {
  So3Spline world_from_camera_rotation;
  VectorSpline camera_in_world_m;
  std::vector<double> view_times_s;  // ascending: where it is known

  // True with a view within `gap_s` before and after.
  bool isKnownAt(double time_s, double gap_s) const;
};
CameraTrajectory trajectoryThrough(const std::vector<CameraPose>& poses, double begin_s, double end_s,
                                   double knot_spacing_s);

// Angular rates as samples, 200 Hz, on the camera's clock.
std::vector<ImuSample> angularRatesOf(const CameraTrajectory& trajectory, std::int64_t start_ns);

struct RelativePose {
  MeanPose reference_from_camera;
  int views = 0;  // that determine it
};
// From views at times when the reference's place is known too; nothing if fewer than `least_views`.
std::optional<RelativePose> relativePose(const CameraTrajectory& reference,
                                         const std::vector<CameraPose>& poses, double time_offset_s,
                                         double gap_s, int least_views);

}  // namespace evical
