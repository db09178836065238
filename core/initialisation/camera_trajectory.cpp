#include "core/initialisation/camera_trajectory.h"

#include "core/base/time.h"
#include "core/geometry/so3.h"
#include "core/geometry/trajectory.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical {

int resolveBySmoothness(std::vector<CameraPose>& poses, double max_pair_s) {
  constexpr int kPasses = 3;
  int swapped = 0;
  for (int round = 0; round < kPasses; ++round) {
    for (std::size_t k = 0; k < poses.size(); ++k) {
      if (!poses[k].other_world_from_camera) continue;
      const auto strain_rad = [&](const RigidTransform& candidate) {
        double sum = 0.0;
        for (const std::size_t i : {k - 1, k + 1}) {  // 0 - 1 is beyond the end, too
          if (i >= poses.size() || std::abs(poses[i].time_s - poses[k].time_s) > max_pair_s) continue;
          sum += rotationAngleBetween_rad(poses[i].world_from_camera.rotation, candidate.rotation);
        }
        return sum;
      };
      if (strain_rad(*poses[k].other_world_from_camera) >= strain_rad(poses[k].world_from_camera)) continue;
      std::swap(*poses[k].other_world_from_camera, poses[k].world_from_camera);
      ++swapped;
    }
  }
  return swapped;
}

bool CameraTrajectory::isKnownAt(double time_s, double gap_s) const {
  const auto after = std::lower_bound(view_times_s.begin(), view_times_s.end(), time_s);
  if (after == view_times_s.begin() || after == view_times_s.end()) return false;
  return *after - time_s <= gap_s && time_s - *(after - 1) <= gap_s;
}

CameraTrajectory trajectoryThrough(const std::vector<CameraPose>& poses, double begin_s, double end_s,
                                   double knot_spacing_s) {
  CameraTrajectory trajectory;
  std::vector<Eigen::Quaterniond> rotations;
  std::vector<Eigen::Vector3d> positions_m;
  for (const CameraPose& pose : poses) {
    if (pose.time_s < begin_s || pose.time_s > end_s) continue;
    trajectory.view_times_s.push_back(pose.time_s);
    rotations.push_back(pose.world_from_camera.rotation);
    positions_m.push_back(pose.world_from_camera.translation_m);
  }
  trajectory.world_from_camera_rotation =
      fitSo3Spline(trajectory.view_times_s, rotations, begin_s, end_s, knot_spacing_s);
  trajectory.camera_in_world_m =
      fitVectorSpline(trajectory.view_times_s, positions_m, begin_s, end_s, knot_spacing_s);
  return trajectory;
}

std::vector<ImuSample> angularRatesOf(const CameraTrajectory& trajectory, std::int64_t start_ns) {
  constexpr double kPeriod_s = 0.005;
  const So3Spline& rotation = trajectory.world_from_camera_rotation;
  std::vector<ImuSample> samples;
  for (double time_s = rotation.start_s; time_s <= rotation.endTime_s(); time_s += kPeriod_s) {
    ImuSample sample;
    sample.time_ns = start_ns + nanosecondsFrom(time_s);
    sample.angular_rate_rad_s = evaluate(rotation, time_s, RotationOrder::Velocity).angular_velocity_rad_s;
    samples.push_back(sample);
  }
  return samples;
}

std::optional<RelativePose> relativePose(const CameraTrajectory& reference,
                                         const std::vector<CameraPose>& poses, double time_offset_s,
                                         double gap_s, int min_views) {
  std::vector<RigidTransform> each;
  for (const CameraPose& pose : poses) {
    const double time_s = pose.time_s + time_offset_s;
    if (!reference.isKnownAt(time_s, gap_s)) continue;
    const RigidTransform world_from_reference =
        worldFromImu(reference.world_from_camera_rotation, reference.camera_in_world_m, time_s);
    each.push_back(inverse(world_from_reference) * pose.world_from_camera);
  }
  if (static_cast<int>(each.size()) < std::max(1, min_views)) return std::nullopt;
  // Mirrored solutions of planar poses are outliers.
  constexpr int kRounds = 20;
  constexpr PoseSpread kSpread{0.02, 0.01};
  return RelativePose{meanPose(each, each[each.size() / 2], kSpread, kRounds), static_cast<int>(each.size())};
}

}  // namespace evical
