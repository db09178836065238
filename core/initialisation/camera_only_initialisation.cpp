#include "core/initialisation/camera_only_initialisation.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/geometry/so3.h"
#include "core/initialisation/camera_alignment.h"
#include "core/initialisation/camera_poses.h"
#include "core/initialisation/further_boards.h"
#include "core/initialisation/initialisation_checks.h"
#include "core/initialisation/mirror_check.h"
#include "core/numerics/angles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

namespace evical {
namespace {

// Cameras without an IMU: the trajectory is the reference camera's, whose rotation replaces a gyroscope.
class CamerasAlone {
 public:
  CamerasAlone(const CalibrationInput& input, const StatedSigns& stated, const InitialisationOptions& options,
               const RunContext& context, Initialisation& result)
      : input_(input), stated_(stated), options_(options), context_(context), result_(result) {}

  void run() {
    followReference();
    CalibrationInput felt = input_;
    ImuData& gyroscope = felt.imus.emplace_back();
    gyroscope.name = reference().name;
    gyroscope.samples = angularRatesOf(trajectory_, input_.start_ns);
    felt.reference_imu = 0;
    const GyroRotation gyro(gyroscope.samples, input_.start_ns);
    checkGyroscope(gyroscope, gyro, options_, result_.warnings);
    result_.state.cameras.resize(input_.cameras.size());
    for (std::size_t k = 0; k < input_.cameras.size(); ++k) {
      context_.throwIfStopped();
      if (k != input_.reference_camera) findOnReference(k, felt, gyro);
    }
    followAllInTurns();
    alignFurtherBoards(input_, before_further_, trajectory_, options_.max_shared_gap_s, options_, result_);
    result_.state.world_from_imu_rotation = std::move(trajectory_.world_from_camera_rotation);
    result_.state.imu_in_world_m = std::move(trajectory_.camera_in_world_m);
  }

 private:
  const CameraData& reference() const { return input_.cameras[input_.reference_camera]; }

  void followReference() {
    Stopwatch stopwatch;
    CameraPoses found =
        estimateCameraPoses(reference(), input_.boardAt(reference().board), options_, context_);
    checkViews(reference(), found, options_);
    const int swapped = resolveBySmoothness(found.poses, options_.max_pair_s);
    poses_ = found.poses;
    trajectory_ = through(poses_);
    result_.steps.push_back(
        {"trajectory", reference().name,
         fmt::format("{} of {} views, points fit to {:.3f} px (median), {} swapped to the "
                     "plane's other pose",
                     found.poses.size(), reference().observations.views.size(), found.median_reprojection_px,
                     swapped),
         found.median_reprojection_px, 0.0, stopwatch.restart_s()});
  }

  CameraTrajectory through(const std::vector<CameraPose>& poses) const {
    return trajectoryThrough(poses, poses.front().time_s - options_.margin_s,
                             poses.back().time_s + options_.margin_s, options_.camera_knot_spacing_s);
  }

  // From simultaneous views of both cameras; else from the gaps when the board passes from one to the other.
  void findOnReference(std::size_t k, const CalibrationInput& felt, const GyroRotation& gyro) {
    const std::size_t steps = result_.steps.size(), warnings = result_.warnings.size();
    std::optional<CalibrationError> mirrored;
    try {
      AlignedCamera aligned = alignCamera(input_.cameras[k], felt, gyro, options_, context_, result_);
      aligned.camera = k;
      AlignedCamera first{poses_, {}, input_.reference_camera};
      first.hand_eye.axis_ratio = 1.0;  // its rotation is the identity, not estimated
      if (input_.cameras[k].board > 0)
        before_further_.emplace(k, std::move(aligned));
      else if (contradictsHandedness(first, aligned, gyro, options_.max_shared_gap_s, options_))
        mirrored = mirroredOfTwo(input_, stated_, first, aligned);
      else
        place(k, aligned);
    } catch (const CalibrationError&) {
      result_.steps.resize(steps);
      result_.warnings.resize(warnings);
      if (input_.cameras[k].board > 0 || !bridge(k)) throw;
    }
    if (mirrored) throw MirrorError(*mirrored);
  }

  bool bridge(std::size_t k) {
    Stopwatch stopwatch;
    const CameraData& camera = input_.cameras[k];
    CameraPoses found = estimateCameraPoses(camera, input_.boardAt(camera.board), options_, context_);
    resolveBySmoothness(found.poses, options_.max_pair_s);
    const auto bridged = bridgeCameras(poses_, found.poses, camera.prior.time_offset, options_, context_);
    if (!bridged) return false;
    const MeanPose& pose = bridged->reference_from_camera;
    result_.state.cameras[k].reference_from_camera = pose.mean;
    result_.state.cameras[k].time_offset_s = bridged->time_offset_s;
    result_.steps.push_back(
        {"camera to camera", camera.name,
         fmt::format("sees the board alternately with {}; {} gaps agree to {:.2f} deg and {:.1f} mm",
                     reference().name, bridged->bridges, pose.rotation_rms_rad * kDegPerRad,
                     pose.position_rms_m * 1e3),
         pose.position_rms_m, 0.0, stopwatch.restart_s()});
    result_.warnings.push_back(fmt::format(
        "{}: never sees the board at the same time as {}: its pose assumes that the rig moves smoothly in "
        "between; show the board to both at the same time, or record with an IMU",
        camera.name, reference().name));
    in_turns_.push_back({k, std::move(found.poses)});
    return true;
  }

  // The trajectory from the reference's views, and the views of cameras that see the board when the reference
  // does not.
  void followAllInTurns() {
    if (in_turns_.empty()) return;
    std::vector<CameraPose> all = poses_;
    for (auto& [k, poses] : in_turns_) {
      const CameraState& state = result_.state.cameras[k];
      for (CameraPose& pose : poses) {
        pose.time_s += state.time_offset_s;
        pose.world_from_camera = pose.world_from_camera * inverse(state.reference_from_camera);
        all.push_back(pose);
      }
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const CameraPose& a, const CameraPose& b) { return a.time_s < b.time_s; });
    trajectory_ = through(all);
  }

  void place(std::size_t k, const AlignedCamera& aligned) {
    const std::string& name = input_.cameras[k].name;
    const double time_offset_s = aligned.hand_eye.time_offset_s;
    const auto found = relativePose(trajectory_, aligned.poses, time_offset_s, options_.max_shared_gap_s,
                                    options_.min_views);
    if (!found) {
      throw calibrationFailed(
          name,
          fmt::format("it and {} have views within {:.2f} s of each other in fewer than {} cases",
                      reference().name, options_.max_shared_gap_s, options_.min_views),
          "Show the board to both at the same time, move it often and quickly from one to the other, "
          "or record with an IMU");
    }
    const MeanPose& pose = found->reference_from_camera;
    if (pose.agreeing < options_.min_agreement) {
      throw calibrationFailed(
          name,
          fmt::format("only {:.0f} % of its views agree on its pose relative to {}", 100.0 * pose.agreeing,
                      reference().name),
          "Check that both see the same board at the same time, and are rigidly connected");
    }
    result_.state.cameras[k].reference_from_camera = pose.mean;
    result_.state.cameras[k].time_offset_s = time_offset_s;
    result_.steps.push_back({"camera to camera", name,
                             fmt::format("{} views agree to {:.3f} deg and {:.2f} mm", found->views,
                                         pose.rotation_rms_rad * kDegPerRad, pose.position_rms_m * 1e3),
                             pose.position_rms_m, 0.0});
  }

  const CalibrationInput& input_;
  const StatedSigns& stated_;
  const InitialisationOptions& options_;
  const RunContext& context_;
  Initialisation& result_;
  std::vector<CameraPose> poses_;  // of the reference camera
  CameraTrajectory trajectory_;
  std::vector<std::pair<std::size_t, std::vector<CameraPose>>> in_turns_;
  std::map<std::size_t, AlignedCamera> before_further_;  // cameras that see other boards than the reference
};

}  // namespace

void initialiseCamerasAlone(const CalibrationInput& input, const StatedSigns& stated,
                            const InitialisationOptions& options, const RunContext& context,
                            Initialisation& result) {
  CamerasAlone(input, stated, options, context, result).run();
}

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

// In order of time on the reference's clock, each change from the views of one camera to those of the other
// is a gap.
Bridges bridges(const std::vector<MovingPose>& reference_views, const std::vector<MovingPose>& camera_views,
                double time_offset_s, double longest_s) {
  constexpr std::size_t kMax = 400;  // limit for cameras that overlap: the first are sufficient
  Bridges found;
  const auto add = [&](const MovingPose& of_reference, const MovingPose& of_camera) {
    const double half_gap_s = 0.5 * (of_camera.time_s + time_offset_s - of_reference.time_s);
    if (2.0 * std::abs(half_gap_s) > longest_s || found.reference_from_camera.size() >= kMax) return;
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
    const Bridges each = bridges(reference_views, camera_views, offset_s, options.max_bridge_s);
    if (!each.bothWays(options.min_bridges)) continue;
    const MeanPose found = agreement(each.reference_from_camera);
    if (found.agreeing < options.min_bridge_agreement) continue;
    if (!best || misfitOf(found) < misfitOf(best->reference_from_camera))
      best = {found, offset_s, static_cast<int>(each.reference_from_camera.size())};
  }
  return best;
}

}  // namespace evical
