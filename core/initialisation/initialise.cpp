#include "core/initialisation/initialise.h"

#include "core/base/error.h"
#include "core/initialisation/bridged_cameras.h"
#include "core/initialisation/camera_imu_rotation.h"
#include "core/initialisation/camera_trajectory.h"
#include "core/initialisation/further_imus.h"
#include "core/initialisation/gravity_alignment.h"
#include "core/initialisation/initialisation_checks.h"
#include "core/initialisation/pose_consistency.h"
#include "core/initialisation/time_offset.h"
#include "core/initialisation/world_rotation.h"

#include "core/geometry/so3.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace evical {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

// Time since it was made or last asked.
class Lap {
 public:
  double next_s() {
    const auto now = Clock::now();
    const double since_s = std::chrono::duration<double>(now - begin_).count();
    begin_ = now;
    return since_s;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

const ImuData& referenceImu(const CalibrationInput& input) {
  return input.imus[input.reference_imu];
}

std::vector<CameraPose> cameraPoses(const CameraData& camera, const CircleBoard& board,
                                    const GyroRotation& gyro, const InitialisationOptions& options,
                                    const RunContext& context, Initialisation& result) {
  CameraPoses found = estimateCameraPoses(camera, board, options, context);
  checkPoses(camera, found, gyro, options);
  result.steps.push_back(
      {"camera poses",
       fmt::format("{}: {} of {} views, circles fit to {:.3f} px (median)", camera.name, found.poses.size(),
                   camera.observations.views.size(), found.median_reprojection_px),
       found.median_reprojection_px, 0.0});
  if (found.rejected > static_cast<int>(found.poses.size())) {
    result.warnings.push_back(fmt::format(
        "{}: the circles of most views ({} of {}) fit the board worse than {:.2f} px; check the "
        "intrinsics and the board",
        camera.name, found.rejected, camera.observations.views.size(), options.largest_reprojection_px));
  }
  return std::move(found.poses);
}

// Hand-eye from one candidate offset, then once more with the poses that the gyroscope believes.
std::optional<AlignedCamera> align(std::vector<CameraPose> poses, const GyroRotation& gyro,
                                   double time_offset_s, const InitialisationOptions& options,
                                   const SensorPrior& prior) {
  resolveAmbiguousPoses(poses, gyro, time_offset_s, options.longest_pair_s);
  const std::optional<HandEye> found = estimateCameraImuRotation(poses, gyro, time_offset_s, options, prior);
  if (!found) return std::nullopt;
  return AlignedCamera{std::move(poses), *found};
}

void warnOfPeaks(const CameraData& camera, const std::vector<TimeOffsetPeak>& peaks, double chosen_s,
                 const InitialisationOptions& options, Initialisation& result) {
  const TimeOffsetPeak& best = peaks.front();
  const std::optional<KnownNumber>& known = camera.prior.time_offset;
  if (known && known->isGiven()) {
    if (best.correlation < options.clear_peak_correlation)
      result.warnings.push_back(
          fmt::format("{}: rotation rates of camera and gyroscope agree weakly (correlation {:.2f}) at the "
                      "time offset of {:.4f} s that is given; check it",
                      camera.name, best.correlation, known->value));
  } else if (best.correlation < options.clear_peak_correlation) {
    result.warnings.push_back(fmt::format(
        "{}: no clear time offset: rotation rates of camera and gyroscope agree weakly (correlation "
        "{:.2f}); rotate more, or give a wider initialisation.time_offset_search_s",
        camera.name, best.correlation));
  } else if (peaks.size() > 1 && best.correlation - peaks[1].correlation < options.clear_peak_lead) {
    result.warnings.push_back(fmt::format(
        "{}: the motion nearly repeats itself: time offsets of {:.3f} s and {:.3f} s correlate almost "
        "equally ({:.3f} and {:.3f}); whole rotations speak for {:.3f} s; move irregularly",
        camera.name, best.time_offset_s, peaks[1].time_offset_s, best.correlation, peaks[1].correlation,
        chosen_s));
  }
}

AlignedCamera bestAlignment(const CameraData& camera, const std::vector<CameraPose>& poses,
                            const std::vector<TimeOffsetPeak>& peaks, const GyroRotation& gyro,
                            const InitialisationOptions& options, const RunContext& context) {
  std::optional<AlignedCamera> best;
  for (const TimeOffsetPeak& peak : peaks) {
    context.throwIfStopped();
    std::optional<AlignedCamera> found = align(poses, gyro, peak.time_offset_s, options, camera.prior);
    // The more significant one stays unless the other is better by more than chance.
    if (found && (!best || found->hand_eye.cost < options.better_alignment * best->hand_eye.cost))
      best = std::move(found);
  }
  if (!best) {
    throw calibrationFailed(camera.name, "too few pairs of views to find the camera's rotation",
                            "Record longer, with the board in view");
  }
  return std::move(*best);
}

// Swaps and drops poses that contradict the gyroscope, and repeats the hand-eye without them.
void settlePoses(const CameraData& camera, const ImuData& imu, std::int64_t start_ns,
                 const GyroRotation& gyro, const InitialisationOptions& options, AlignedCamera& aligned,
                 Initialisation& result) {
  constexpr int kRounds = 2;
  int swapped = 0, dropped = 0;
  for (int round = 0; round < kRounds; ++round) {
    const GyroRotation unbiased(imu.samples, start_ns, aligned.hand_eye.gyroscope_bias_rad_s);
    AlignedCamera next = aligned;
    const PoseConsistency consistency = keepConsistentPoses(next.poses, unbiased, next.hand_eye, options);
    const auto again =
        estimateCameraImuRotation(next.poses, gyro, next.hand_eye.time_offset_s, options, camera.prior);
    if (!again || static_cast<int>(next.poses.size()) < options.least_views) {
      result.warnings.push_back(camera.name +
                                ": rotations of camera and gyroscope contradict each other in most views");
      return;
    }
    next.hand_eye = *again;
    aligned = std::move(next);
    swapped += consistency.swapped;
    dropped += consistency.dropped;
    if (consistency.swapped == 0 && consistency.dropped == 0) break;
  }
  const auto views = static_cast<int>(aligned.poses.size()) + dropped;
  result.steps.push_back({"planar poses",
                          fmt::format("{}: the gyroscope turned {} views to the plane's other pose and "
                                      "contradicts {} of {}",
                                      camera.name, swapped, dropped, views),
                          static_cast<double>(dropped) / views, 0.0});
}

AlignedCamera alignCamera(const CameraData& camera, const CalibrationInput& input, const GyroRotation& gyro,
                          const InitialisationOptions& options, const RunContext& context,
                          Initialisation& result) {
  const ImuData& imu = referenceImu(input);
  Lap lap;
  const std::vector<CameraPose> poses = cameraPoses(camera, input.board, gyro, options, context, result);
  result.steps.back().duration_s = lap.next_s();
  context.throwIfStopped();
  const std::vector<TimeOffsetPeak> peaks = correlateTimeOffset(poses, gyro, options, camera.prior);
  if (peaks.empty()) {
    throw calibrationFailed(camera.name,
                            "too few pairs of views overlap with the gyroscope to find the time offset",
                            "Record longer, with the board in view");
  }
  const double offset_s = lap.next_s();
  AlignedCamera aligned = bestAlignment(camera, poses, peaks, gyro, options, context);
  context.throwIfStopped();
  const double rotation_s = lap.next_s();
  settlePoses(camera, imu, input.start_ns, gyro, options, aligned, result);
  if (result.steps.back().name == "planar poses") result.steps.back().duration_s = lap.next_s();
  const HandEye& hand_eye = aligned.hand_eye;
  warnOfPeaks(camera, peaks, hand_eye.time_offset_s, options, result);
  const double next = peaks.size() > 1 ? peaks[1].correlation : 0.0;
  result.steps.push_back(
      {"time offset",
       fmt::format("{}: {:.4f} s, correlation {:.3f}, peak {:.0f} ms wide, next best {:.3f}", camera.name,
                   hand_eye.time_offset_s, peaks.front().correlation, peaks.front().width_s * 1e3, next),
       1.0 - peaks.front().correlation, peaks.front().correlation - next, offset_s});
  result.steps.push_back(
      {"camera-IMU rotation",
       fmt::format("{}: {} pairs agree to {:.3f} deg, second axis {:.2f} of the first", camera.name,
                   hand_eye.pairs, hand_eye.residual_rad * kDegPerRad, hand_eye.axis_ratio),
       hand_eye.residual_rad, hand_eye.axis_ratio, rotation_s});
  return aligned;
}

struct TimeRange {
  double begin_s = std::numeric_limits<double>::infinity(), end_s = -begin_s;
};

TimeRange viewRange(const std::vector<AlignedCamera>& cameras) {
  TimeRange range;
  for (const AlignedCamera& camera : cameras) {
    range.begin_s = std::min(range.begin_s, camera.poses.front().time_s + camera.hand_eye.time_offset_s);
    range.end_s = std::max(range.end_s, camera.poses.back().time_s + camera.hand_eye.time_offset_s);
  }
  return range;
}

std::vector<CameraTrack> tracksOf(const CalibrationInput& input, const std::vector<AlignedCamera>& cameras) {
  std::vector<CameraTrack> tracks;
  for (std::size_t k = 0; k < cameras.size(); ++k)
    tracks.push_back(
        {cameras[k].poses, cameras[k].hand_eye.time_offset_s, input.cameras[k].prior.translation});
  return tracks;
}

// With rotation about one axis only, accelerations say how the camera is turned about it.
void turnAboutAxis(const CalibrationInput& input, const InitialisationOptions& options, TimeRange range,
                   const GyroRotation& gyro, const RunContext& context, std::vector<AlignedCamera>& cameras,
                   Initialisation& result) {
  HandEye& first = cameras.front().hand_eye;
  if (first.axis_ratio >= options.least_axis_ratio) return;
  result.warnings.push_back(input.cameras.front().name +
                            ": the recording rotates about one axis only: rotate about two more");
  const std::optional<KnownRotation>& known = input.cameras.front().prior.rotation;
  if (known && known->isGiven()) return;
  // The angle needs no fine knots.
  constexpr double kLeastKnot_s = 0.05;
  const double knot_s = std::max(options.knot_spacing_s, kLeastKnot_s);
  const So3Spline rotation = fitWorldRotation({cameras.data(), 1}, gyro, range.begin_s, range.end_s, knot_s);
  const double turn_rad =
      findTurnAboutAxis(first.main_axis_in_imu, tracksOf(input, cameras), referenceImu(input).samples,
                        input.start_ns, rotation, options, context);
  for (AlignedCamera& camera : cameras) {
    camera.hand_eye.imu_from_camera =
        quaternionExp(-turn_rad * first.main_axis_in_imu) * camera.hand_eye.imu_from_camera;
  }
}

void checkBoardScale(const GravityAlignment& gravity, const CircleBoard& board,
                     const InitialisationOptions& options, Initialisation& result) {
  const double excess = gravity.board_scale - 1.0, sigma = gravity.board_scale_std;
  result.steps.push_back({"board scale",
                          fmt::format("accelerations make the board {:.3f} +- {:.3f} times as large as given",
                                      gravity.board_scale, sigma),
                          std::abs(excess), sigma});
  if (std::abs(excess) < options.largest_scale_error || std::abs(excess) < options.scale_error_sigmas * sigma)
    return;
  result.doubt = fmt::format("the board seems {:.0f} % {} than spacing_m says ({:.4g} m): measure it",
                             100.0 * std::abs(excess), excess > 0.0 ? "larger" : "smaller", board.spacing_m);
  result.warnings.push_back(result.doubt);
}

void alignTranslations(const CalibrationInput& input, const InitialisationOptions& options,
                       const std::vector<AlignedCamera>& cameras, const RunContext& context,
                       Initialisation& result) {
  CalibrationState& state = result.state;
  Lap lap;
  const GravityAlignment gravity =
      alignGravity(tracksOf(input, cameras), referenceImu(input).samples, input.start_ns,
                   state.world_from_imu_rotation, options, context);
  result.steps.push_back(
      {"gravity and translation",
       fmt::format("positions agree to {:.2f} mm in {} of {} views, accelerations to {:.3f} m/s^2",
                   gravity.position_rms_m * 1e3, gravity.views - gravity.outlying_views, gravity.views,
                   gravity.acceleration_rms_m_s2),
       gravity.position_rms_m, gravity.lever_std_m, lap.next_s()});
  if (gravity.outlying_views > 0) {
    result.warnings.push_back(
        fmt::format("{} of {} views put the camera where its neighbours and the IMU don't: the board was "
                    "probably misread",
                    gravity.outlying_views, gravity.views));
  }
  checkBoardScale(gravity, input.board, options, result);
  state.imu_in_world_m = gravity.imu_in_world_m;
  state.gravity_in_world_m_s2 = gravity.gravity_in_world_m_s2;
  state.imus.resize(input.imus.size());
  ImuState& reference = state.imus[input.reference_imu];
  reference.gyroscope_bias_rad_s = cameras.front().hand_eye.gyroscope_bias_rad_s;
  reference.accelerometer_bias_m_s2 = gravity.accelerometer_bias_m_s2;
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    CameraState camera;
    camera.imu_from_camera = {cameras[k].hand_eye.imu_from_camera, gravity.cameras_in_imu_m[k]};
    camera.time_offset_s = cameras[k].hand_eye.time_offset_s;
    state.cameras.push_back(camera);
  }
}

void alignFurtherImu(const CalibrationInput& input, std::size_t k, const GyroRotation& reference,
                     const InitialisationOptions& options, const RunContext& context,
                     Initialisation& result) {
  const ImuData& imu = input.imus[k];
  Lap lap;
  const ImuRotation rotation = alignFurtherGyroscope(imu, input.start_ns, reference, options, context);
  const LeverArm lever = solveLeverArm(imu, input.start_ns, rotation, result.state, options);
  const HandEye& hand_eye = rotation.hand_eye;
  ImuState& state = result.state.imus[k];
  state.reference_from_imu = {hand_eye.imu_from_camera, lever.imu_in_reference_m};
  state.time_offset_s = hand_eye.time_offset_s;
  state.gyroscope_bias_rad_s = hand_eye.gyroscope_bias_rad_s;
  state.accelerometer_bias_m_s2 = lever.accelerometer_bias_m_s2;
  result.steps.push_back(
      {"IMU to IMU",
       fmt::format(
           "{}: time offset {:.4f} s (correlation {:.3f}), rotations agree to {:.3f} deg, accelerations to "
           "{:.3f} m/s^2",
           imu.name, hand_eye.time_offset_s, rotation.correlation, hand_eye.residual_rad * kDegPerRad,
           lever.force_rms_m_s2),
       hand_eye.residual_rad, lever.std_m, lap.next_s()});
}

// Tells the observer of the steps that it has not heard of.
void tellSteps(const std::vector<InitialisationStep>& steps, CalibrationObserver* observer,
               std::size_t& told) {
  for (; observer != nullptr && told < steps.size(); ++told)
    observer->initialisationStepDone(steps[told].name, steps[told].result, steps[told].duration_s);
}

// Cameras alone: the trajectory is the reference camera's, and a gyroscope on it would feel its rotation.
class CamerasAlone {
 public:
  CamerasAlone(const CalibrationInput& input, const InitialisationOptions& options, const RunContext& context,
               Initialisation& result)
      : input_(input), options_(options), context_(context), result_(result) {}

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
    result_.state.world_from_imu_rotation = std::move(trajectory_.world_from_camera_rotation);
    result_.state.imu_in_world_m = std::move(trajectory_.camera_in_world_m);
  }

 private:
  const CameraData& reference() const { return input_.cameras[input_.reference_camera]; }

  void followReference() {
    Lap lap;
    CameraPoses found = estimateCameraPoses(reference(), input_.board, options_, context_);
    checkViews(reference(), found, options_);
    const int swapped = resolveBySmoothness(found.poses, options_.longest_pair_s);
    poses_ = found.poses;
    trajectory_ = through(poses_);
    result_.steps.push_back(
        {"trajectory",
         fmt::format("{}: {} of {} views, circles fit to {:.3f} px (median), {} turned to the "
                     "plane's other pose",
                     reference().name, found.poses.size(), reference().observations.views.size(),
                     found.median_reprojection_px, swapped),
         found.median_reprojection_px, 0.0, lap.next_s()});
  }

  CameraTrajectory through(const std::vector<CameraPose>& poses) const {
    return trajectoryThrough(poses, poses.front().time_s - options_.margin_s,
                             poses.back().time_s + options_.margin_s, options_.camera_knot_spacing_s);
  }

  // By what both see at the same time; else by the moments when the board passes from one to the other.
  void findOnReference(std::size_t k, const CalibrationInput& felt, const GyroRotation& gyro) {
    const std::size_t steps = result_.steps.size(), warnings = result_.warnings.size();
    try {
      place(k, alignCamera(input_.cameras[k], felt, gyro, options_, context_, result_));
    } catch (const CalibrationError&) {
      result_.steps.resize(steps);
      result_.warnings.resize(warnings);
      if (!bridge(k)) throw;
    }
  }

  bool bridge(std::size_t k) {
    Lap lap;
    const CameraData& camera = input_.cameras[k];
    CameraPoses found = estimateCameraPoses(camera, input_.board, options_, context_);
    resolveBySmoothness(found.poses, options_.longest_pair_s);
    const auto bridged = bridgeCameras(poses_, found.poses, options_, context_);
    if (!bridged) return false;
    result_.state.cameras[k].imu_from_camera = bridged->reference_from_camera;
    result_.state.cameras[k].time_offset_s = bridged->time_offset_s;
    result_.steps.push_back(
        {"camera to camera",
         fmt::format("{}: sees the board in turns with {}; {} gaps agree to {:.2f} deg and {:.1f} mm",
                     camera.name, reference().name, bridged->bridges, bridged->rotation_rms_rad * kDegPerRad,
                     bridged->position_rms_m * 1e3),
         bridged->position_rms_m, 0.0, lap.next_s()});
    result_.warnings.push_back(
        fmt::format("{}: never sees the board together with {}: what is known of it rests on how evenly the "
                    "rig moves between; let both see the board at once, or record with an IMU",
                    camera.name, reference().name));
    in_turns_.push_back({k, std::move(found.poses)});
    return true;
  }

  // The others' views where the reference sees nothing.
  void followAllInTurns() {
    if (in_turns_.empty()) return;
    std::vector<CameraPose> all = poses_;
    for (auto& [k, poses] : in_turns_) {
      const CameraState& state = result_.state.cameras[k];
      for (CameraPose& pose : poses) {
        pose.time_s += state.time_offset_s;
        pose.world_from_camera = pose.world_from_camera * inverse(state.imu_from_camera);
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
    const auto pose = relativePose(trajectory_, aligned.poses, time_offset_s, options_.longest_shared_gap_s,
                                   options_.least_views);
    if (!pose) {
      throw calibrationFailed(
          name,
          fmt::format("it and {} see the board within {:.2f} s of each other in fewer than {} views",
                      reference().name, options_.longest_shared_gap_s, options_.least_views),
          "Let both see the board at the same time, let it pass from one to the other often and without "
          "delay, or record with an IMU");
    }
    if (pose->agreeing < options_.least_agreement) {
      throw calibrationFailed(name,
                              fmt::format("only {:.0f} % of its views agree on how it sits on {}",
                                          100.0 * pose->agreeing, reference().name),
                              "Check that both see one board at the same time and are fixed to each other");
    }
    result_.state.cameras[k].imu_from_camera = pose->reference_from_camera;
    result_.state.cameras[k].time_offset_s = time_offset_s;
    result_.steps.push_back({"camera to camera",
                             fmt::format("{}: {} views agree to {:.3f} deg and {:.2f} mm", name, pose->views,
                                         pose->rotation_rms_rad * kDegPerRad, pose->position_rms_m * 1e3),
                             pose->position_rms_m, 0.0});
  }

  const CalibrationInput& input_;
  const InitialisationOptions& options_;
  const RunContext& context_;
  Initialisation& result_;
  std::vector<CameraPose> poses_;  // of the reference
  CameraTrajectory trajectory_;
  std::vector<std::pair<std::size_t, std::vector<CameraPose>>> in_turns_;
};

}  // namespace

Initialisation initialise(const CalibrationInput& input, const InitialisationOptions& options,
                          const RunContext& context, CalibrationObserver* observer) {
  Initialisation result;
  std::size_t told = 0;
  checkInput(input, options);
  if (input.imus.empty()) {
    CamerasAlone(input, options, context, result).run();
    tellSteps(result.steps, observer, told);
    context.progress.stageProgress(1.0);
    return result;
  }
  const ImuData& imu = referenceImu(input);
  const GyroRotation gyro(imu.samples, input.start_ns);
  checkGyroscope(imu, gyro, options, result.warnings);
  std::vector<AlignedCamera> cameras;
  for (const CameraData& camera : input.cameras) {
    context.throwIfStopped();
    cameras.push_back(alignCamera(camera, input, gyro, options, context, result));
    tellSteps(result.steps, observer, told);
    constexpr double kShare = 0.7;
    context.progress.stageProgress(kShare * static_cast<double>(cameras.size()) /
                                   static_cast<double>(input.cameras.size()));
  }
  const TimeRange views = viewRange(cameras);
  checkOverlap(imu, views.begin_s, views.end_s, gyro.begin_s(), gyro.end_s(), options);
  const TimeRange range{std::max(views.begin_s - options.margin_s, gyro.begin_s()),
                        std::min(views.end_s + options.margin_s, gyro.end_s())};
  const GyroRotation unbiased(imu.samples, input.start_ns, cameras.front().hand_eye.gyroscope_bias_rad_s);
  turnAboutAxis(input, options, range, unbiased, context, cameras, result);
  context.throwIfStopped();
  result.state.world_from_imu_rotation =
      fitWorldRotation(cameras, unbiased, range.begin_s, range.end_s, options.knot_spacing_s);
  context.throwIfStopped();
  alignTranslations(input, options, cameras, context, result);
  for (std::size_t k = 0; k < input.imus.size(); ++k) {
    if (k != input.reference_imu) alignFurtherImu(input, k, unbiased, options, context, result);
  }
  tellSteps(result.steps, observer, told);
  context.progress.stageProgress(1.0);
  return result;
}

}  // namespace evical
