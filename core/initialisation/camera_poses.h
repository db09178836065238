// Camera poses from single views of the board (docs/maths.md, 8.2).
#pragma once

#include "core/initialisation/gyro_rotation.h"
#include "core/initialisation/initialisation_options.h"

#include "core/base/progress.h"
#include "core/data/calibration_setup.h"
#include "core/data/imu_sample.h"
#include "core/geometry/so3.h"
#include "core/geometry/so3_spline.h"
#include "core/geometry/vector_spline.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace evical {

struct CameraPose {
  double time_s = 0.0;  // camera clock
  RigidTransform world_from_camera;
  double reprojection_px = 0.0;  // RMS
  std::size_t view = 0;          // index into the observations' views
  // The other pose that a plane allows, if it fits almost equally well.
  std::optional<RigidTransform> other_world_from_camera;
};

struct CameraPoses {
  std::vector<CameraPose> poses;
  int rejected = 0;                     // views with errors above the option's limit, or without a fit
  double median_reprojection_px = 0.0;  // of all views, including rejected ones
};

// One pose per view, with circles moved to view.time_s.
CameraPoses estimateCameraPoses(const CameraData& camera, const Board& board,
                                const InitialisationOptions& options, const RunContext& context = {});

// For views with two possible poses, selects the one whose rotation relative to its neighbours has the
// gyroscope's magnitude. Returns the number of swapped ones.
int resolveAmbiguousPoses(std::vector<CameraPose>& poses, const GyroRotation& gyro, double time_offset_s,
                          double max_pair_s);

// Mean of several estimates of one pose, with robust weights.

// Distances at which a pose has half its weight.
struct PoseSpread {
  double rotation_rad = 0.0, position_m = 0.0;

  // Squared distance in these units: for an angle and a distance, and between two poses.
  double squared(double angle_rad, double way_m) const {
    const double angle = angle_rad / rotation_rad, way = way_m / position_m;
    return angle * angle + way * way;
  }
  double between2(const RigidTransform& a, const RigidTransform& b) const;
};

struct MeanPose {
  RigidTransform mean;                                  // target_from_source, like the poses
  double agreeing = 0.0;                                // share of poses close to the mean
  double rotation_rms_rad = 0.0, position_rms_m = 0.0;  // robust
};
// `start`: close to most of them.
MeanPose meanPose(std::span<const RigidTransform> poses, const RigidTransform& start,
                  const PoseSpread& spread, int rounds);

// The reference camera's own motion, if there is no IMU: splines through its poses, equivalent gyroscope
// samples, and the other cameras' poses relative to it.

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
