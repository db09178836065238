#include "core/initialisation/non_overlapping_cameras.h"

#include "core/geometry/so3.h"
#include "core/initialisation/camera_trajectory.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace evical {
namespace {

// Wide, so that speeds at an interval's end are averages over several views.
constexpr double kKnotSpacing_s = 0.08;
// Largest difference between two consistent gaps: after extrapolation over some tenths of a second, hands
// deviate by a degree or two.
constexpr PoseSpread kSpread{0.04, 0.03};

// A view with the rates of motion.
struct MovingPose {
  double time_s = 0.0;
  RigidTransform world_from_camera;
  Eigen::Vector3d angular_velocity_rad_s, velocity_m_s;  // in the camera's and in the world's frame

  RigidTransform after(double duration_s) const {
    return {(world_from_camera.rotation * quaternionExp(duration_s * angular_velocity_rad_s)).normalized(),
            world_from_camera.translation_m + duration_s * velocity_m_s};
  }
};

std::vector<MovingPose> movingPoses(const std::vector<CameraPose>& poses) {
  const CameraTrajectory trajectory =
      trajectoryThrough(poses, poses.front().time_s, poses.back().time_s, kKnotSpacing_s);
  std::vector<MovingPose> moving;
  for (const CameraPose& pose : poses) {
    const RotationSample rotation =
        evaluate(trajectory.world_from_camera_rotation, pose.time_s, RotationOrder::Velocity);
    const VectorSample position = evaluate(trajectory.camera_in_world_m, pose.time_s);
    moving.push_back({pose.time_s,
                      {Eigen::Quaterniond(rotation.rotation), position.value},
                      rotation.angular_velocity_rad_s,
                      position.velocity});
  }
  return moving;
}

struct Bridges {
  std::vector<RigidTransform> reference_from_camera;  // by each gap
  int to_camera = 0, to_reference = 0;  // counts, by the camera that sees more of the board after the gap

  // With one direction only, a time offset cannot be distinguished from a rotation.
  bool bothWays(int least) const { return 2 * std::min(to_camera, to_reference) >= least; }
};

std::ptrdiff_t viewsBetween(const std::vector<MovingPose>& poses, double begin_s, double end_s) {
  const auto earlier = [](const MovingPose& pose, double time_s) { return pose.time_s < time_s; };
  return std::lower_bound(poses.begin(), poses.end(), end_s, earlier) -
         std::lower_bound(poses.begin(), poses.end(), begin_s, earlier);
}

// In order of time on the reference's clock, each change from the views of one camera to those of the other is a gap.
Bridges bridges(const std::vector<MovingPose>& reference_views, const std::vector<MovingPose>& camera_views,
                double time_offset_s, double longest_s) {
  constexpr std::size_t kMost = 400;  // limit for cameras that overlap: the first are sufficient
  Bridges found;
  const auto add = [&](const MovingPose& of_reference, const MovingPose& of_camera) {
    const double half_gap_s = 0.5 * (of_camera.time_s + time_offset_s - of_reference.time_s);
    if (2.0 * std::abs(half_gap_s) > longest_s || found.reference_from_camera.size() >= kMost) return;
    found.reference_from_camera.push_back(inverse(of_reference.after(half_gap_s)) *
                                          of_camera.after(-half_gap_s));
    const double middle_s = of_reference.time_s + half_gap_s, camera_middle_s = middle_s - time_offset_s;
    // Views of the reference less those of the camera, on both sides of the gap.
    const auto surplus_before = viewsBetween(reference_views, middle_s - longest_s, middle_s) -
                                viewsBetween(camera_views, camera_middle_s - longest_s, camera_middle_s),
               surplus_after = viewsBetween(reference_views, middle_s, middle_s + longest_s) -
                               viewsBetween(camera_views, camera_middle_s, camera_middle_s + longest_s);
    found.to_camera += surplus_before > 0 && surplus_after < 0;
    found.to_reference += surplus_before < 0 && surplus_after > 0;
  };
  auto reference = reference_views.begin(), camera = camera_views.begin();  // the next of each
  bool was_of_camera = false;
  while (reference != reference_views.end() || camera != camera_views.end()) {
    const bool is_of_camera =
        reference == reference_views.end() ||
        (camera != camera_views.end() && camera->time_s + time_offset_s < reference->time_s);
    if (is_of_camera && !was_of_camera && reference != reference_views.begin())
      add(*std::prev(reference), *camera);
    if (!is_of_camera && was_of_camera) add(*reference, *std::prev(camera));
    ++(is_of_camera ? camera : reference);
    was_of_camera = is_of_camera;
  }
  return found;
}

// Starts from the gap that agrees with most of the others.
MeanPose agreement(const std::vector<RigidTransform>& each) {
  constexpr int kRounds = 10;
  const auto misfit = [&](const RigidTransform& mean) {
    double sum = 0.0;
    for (const RigidTransform& pose : each) sum += std::min(1.0, kSpread.between2(pose, mean));
    return sum;
  };
  const RigidTransform start = *std::min_element(
      each.begin(), each.end(),
      [&](const RigidTransform& a, const RigidTransform& b) { return misfit(a) < misfit(b); });
  return meanPose(each, start, kSpread, kRounds);
}

double misfitOf(const MeanPose& found) {
  return kSpread.squared(found.rotation_rms_rad, found.position_rms_m) / std::max(found.agreeing, 1e-3);
}

}  // namespace

std::optional<BridgedCamera> bridgeCameras(const std::vector<CameraPose>& reference,
                                           const std::vector<CameraPose>& camera,
                                           const std::optional<KnownNumber>& time_offset,
                                           const InitialisationOptions& options, const RunContext& context) {
  constexpr double kStep_s = 0.01;
  if (reference.size() < 2 || camera.size() < 2) return std::nullopt;
  const std::vector<MovingPose> reference_views = movingPoses(reference), camera_views = movingPoses(camera);
  std::optional<BridgedCamera> best;
  const double centre_s = time_offset ? time_offset->value : 0.0;
  const int steps = isGiven(time_offset) ? 0 : static_cast<int>(options.time_offset_search_s / kStep_s);
  for (int step = -steps; step <= steps; ++step) {
    context.throwIfStopped();
    const double offset_s = centre_s + step * kStep_s;
    const Bridges each = bridges(reference_views, camera_views, offset_s, options.longest_bridge_s);
    if (!each.bothWays(options.least_bridges)) continue;
    const MeanPose found = agreement(each.reference_from_camera);
    if (found.agreeing < options.least_bridge_agreement) continue;
    if (!best || misfitOf(found) < misfitOf(best->reference_from_camera))
      best = {found, offset_s, static_cast<int>(each.reference_from_camera.size())};
  }
  return best;
}

}  // namespace evical
