#include "core/initialisation/camera_only_initialisation.h"

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/initialisation/camera_alignment.h"
#include "core/initialisation/camera_trajectory.h"
#include "core/initialisation/further_boards.h"
#include "core/initialisation/initialisation_checks.h"
#include "core/initialisation/mirror_check.h"
#include "core/initialisation/non_overlapping_cameras.h"
#include "core/numerics/angles.h"

#include <fmt/format.h>

#include <algorithm>
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
    alignFurtherBoards(input_, before_further_, trajectory_, options_.longest_shared_gap_s, options_,
                       result_);
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
    const int swapped = resolveBySmoothness(found.poses, options_.longest_pair_s);
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
      else if (contradictsHandedness(first, aligned, gyro, options_.longest_shared_gap_s, options_))
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
    resolveBySmoothness(found.poses, options_.longest_pair_s);
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
    const auto found = relativePose(trajectory_, aligned.poses, time_offset_s, options_.longest_shared_gap_s,
                                    options_.least_views);
    if (!found) {
      throw calibrationFailed(
          name,
          fmt::format("it and {} have views within {:.2f} s of each other in fewer than {} cases",
                      reference().name, options_.longest_shared_gap_s, options_.least_views),
          "Show the board to both at the same time, move it often and quickly from one to the other, "
          "or record with an IMU");
    }
    const MeanPose& pose = found->reference_from_camera;
    if (pose.agreeing < options_.least_agreement) {
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

}  // namespace evical
