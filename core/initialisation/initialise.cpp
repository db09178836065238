#include "core/initialisation/initialise.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/geometry/so3.h"
#include "core/initialisation/camera_imu_rotation.h"
#include "core/initialisation/camera_poses.h"
#include "core/initialisation/gravity_alignment.h"
#include "core/initialisation/time_offset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace evical {
namespace {

constexpr double kClearPeak = 0.7;    // correlation
constexpr double kClearLead = 0.02;   // over the runner-up
constexpr double kDriftKnot_s = 1.0;  // gyroscope drift is followed this finely
constexpr double kDegPerRad = 57.29577951308232;

const ImuData& referenceImu(const CalibrationInput& input, const InitialisationOptions& options) {
  if (input.imus.empty()) {
    throw calibrationFailed("session", "there is no IMU",
                            "Add one under imus:, or calibrate the camera alone");
  }
  if (input.imus.size() > 1) {
    throw calibrationFailed("session", "more than one IMU cannot be calibrated yet", "Name one IMU only");
  }
  const ImuData& imu = input.imus[input.reference_imu];
  constexpr std::size_t kLeastSamples = 50;
  if (imu.samples.size() < kLeastSamples) {
    throw calibrationFailed(imu.name, fmt::format("has {} samples only", imu.samples.size()),
                            "Check the IMU's stream, and record for 30 s");
  }
  static_cast<void>(options);
  return imu;
}

void checkOverlap(const CameraData& camera, const std::vector<CameraPose>& poses, const GyroRotation& gyro,
                  const InitialisationOptions& options) {
  if (static_cast<int>(poses.size()) < options.least_views) {
    throw calibrationFailed(
        camera.name,
        fmt::format("the board gave a camera pose in {} of {} windows only; {} are needed", poses.size(),
                    camera.observations.windows.size(), options.least_views),
        "Look at the detections (evical detect --images), check rows, cols and the intrinsics, and keep the "
        "board in view");
  }
  const double begin_s = std::max(poses.front().time_s, gyro.begin_s() - options.time_offset_search_s);
  const double end_s = std::min(poses.back().time_s, gyro.end_s() + options.time_offset_search_s);
  if (end_s - begin_s < options.least_overlap_s) {
    const bool apart = end_s <= begin_s;
    throw calibrationFailed(
        camera.name,
        fmt::format("camera and IMU {}: the board is seen from {:.3f} s to {:.3f} s, the IMU recorded from "
                    "{:.3f} s to {:.3f} s",
                    apart ? "do not overlap in time" : "overlap too shortly", poses.front().time_s,
                    poses.back().time_s, gyro.begin_s(), gyro.end_s()),
        apart ? "Check the clocks, or widen initialisation.time_offset_search_s" : "Record for 30 s");
  }
}

struct Aligned {
  std::vector<CameraPose> poses;
  HandEye hand_eye;
};

HandEye findHandEye(const CameraData& camera, std::vector<CameraPose>& poses, const GyroRotation& gyro,
                    const InitialisationOptions& options, Initialisation& result) {
  const std::vector<TimeOffsetPeak> peaks =
      correlateTimeOffset(poses, gyro, options.time_offset_search_s, options.longest_pair_s);
  if (peaks.empty()) {
    throw calibrationFailed(camera.name,
                            "too few pairs of views overlap with the gyroscope to find the time offset",
                            "Record longer, with the board in view");
  }
  if (peaks.front().correlation < kClearPeak) {
    result.warnings.push_back(
        fmt::format("{}: rotation rates of camera and gyroscope agree weakly (correlation {:.2f}): the time "
                    "offset may be "
                    "wrong; rotate more, or give a wider initialisation.time_offset_search_s",
                    camera.name, peaks.front().correlation));
  } else if (peaks.size() > 1 && peaks.front().correlation - peaks[1].correlation < kClearLead) {
    result.warnings.push_back(
        fmt::format("{}: the motion nearly repeats itself: time offsets of {:.3f} s and {:.3f} s fit almost "
                    "equally; move irregularly",
                    camera.name, peaks[0].time_offset_s, peaks[1].time_offset_s));
  }
  std::optional<HandEye> best;
  std::vector<CameraPose> best_poses;
  for (const TimeOffsetPeak& peak : peaks) {
    std::vector<CameraPose> tried = poses;
    resolveAmbiguousPoses(tried, gyro, peak.time_offset_s, options.longest_pair_s);
    const std::optional<HandEye> found = estimateCameraImuRotation(
        tried, gyro, peak.time_offset_s, options.pair_gap_s, options.longest_pair_s);
    if (found && (!best || found->residual_rad < 0.9 * best->residual_rad)) {
      best = found;
      best_poses = std::move(tried);
    }
  }
  if (!best) {
    throw calibrationFailed(camera.name, "too few pairs of views to find the camera's rotation",
                            "Record longer, with the board in view");
  }
  poses = std::move(best_poses);
  result.steps.push_back(
      {"time offset",
       fmt::format("{:.4f} s, correlation {:.3f}", best->time_offset_s, peaks.front().correlation),
       1.0 - peaks.front().correlation, 0.0});
  result.steps.push_back({"camera-IMU rotation",
                          fmt::format("pairs agree to {:.3f} deg, second axis {:.2f} of the first",
                                      best->residual_rad * kDegPerRad, best->axis_ratio),
                          best->residual_rad, best->axis_ratio});
  if (best->axis_ratio < options.least_axis_ratio) {
    result.warnings.push_back(camera.name +
                              ": the recording rotates about one axis only: rotate about two more");
  }
  return *best;
}

// The gyroscope's rotation, turned into the world and held to the camera's: its slow drift is fitted by a
// spline of its own.
So3Spline fitWorldRotation(const std::vector<CameraPose>& poses, const HandEye& hand_eye,
                           const GyroRotation& gyro, double begin_s, double end_s, double knot_spacing_s) {
  std::vector<double> times;
  std::vector<Eigen::Quaterniond> world_from_first;
  for (const CameraPose& pose : poses) {
    const double time_s = pose.time_s + hand_eye.time_offset_s;
    if (time_s < begin_s || time_s > end_s) continue;
    times.push_back(time_s);
    world_from_first.push_back(pose.world_from_camera.rotation * hand_eye.imu_from_camera.conjugate() *
                               gyro.at(time_s).conjugate());
  }
  const So3Spline drift = fitSo3Spline(times, world_from_first, begin_s, end_s, kDriftKnot_s);
  std::vector<double> sample_times;
  std::vector<Eigen::Quaterniond> rotations;
  constexpr int kPerKnot = 4;
  const int count = static_cast<int>((end_s - begin_s) / knot_spacing_s * kPerKnot);
  for (int k = 0; k <= count; ++k) {
    const double time_s = begin_s + (end_s - begin_s) * k / count;
    sample_times.push_back(time_s);
    rotations.push_back(Eigen::Quaterniond(evaluate(drift, time_s, RotationOrder::Rotation).rotation) *
                        gyro.at(time_s));
  }
  return fitSo3Spline(sample_times, rotations, begin_s, end_s, knot_spacing_s);
}

}  // namespace

Initialisation initialise(const CalibrationInput& input, const InitialisationOptions& options,
                          const RunContext& context) {
  Initialisation result;
  const ImuData& imu = referenceImu(input, options);
  GyroRotation gyro(imu.samples, input.start_ns);
  if (gyro.rateRms_rad_s() < options.least_rotation_rate_rad_s) {
    throw calibrationFailed(imu.name,
                            fmt::format("the recording hardly moves: the gyroscope turns at {:.4f} rad/s RMS",
                                        gyro.rateRms_rad_s()),
                            "Rotate the rig about all three axes while the board is in view");
  }
  std::vector<std::vector<CameraPose>> poses;
  std::vector<HandEye> hand_eyes;
  double begin_s = 1e300, end_s = -1e300;
  for (const CameraData& camera : input.cameras) {
    context.throwIfStopped();
    if (!camera.intrinsics)
      throw calibrationFailed(camera.name, "has no intrinsics", "Give them in the session");
    poses.push_back(estimateCameraPoses(camera, input.board, options.largest_reprojection_px));
    checkOverlap(camera, poses.back(), gyro, options);
    double squares = 0.0;
    for (const CameraPose& pose : poses.back()) squares += pose.reprojection_px * pose.reprojection_px;
    const double rms = std::sqrt(squares / static_cast<double>(poses.back().size()));
    result.steps.push_back({"camera poses",
                            fmt::format("{}: {} of {} views, {:.3f} px", camera.name, poses.back().size(),
                                        camera.observations.views.size(), rms),
                            rms, 0.0});
    context.progress.stageProgress(0.3);
    hand_eyes.push_back(findHandEye(camera, poses.back(), gyro, options, result));
    begin_s = std::min(begin_s, poses.back().front().time_s + hand_eyes.back().time_offset_s);
    end_s = std::max(end_s, poses.back().back().time_s + hand_eyes.back().time_offset_s);
  }
  context.throwIfStopped();
  context.progress.stageProgress(0.6);
  const HandEye& first = hand_eyes.front();
  gyro = GyroRotation(imu.samples, input.start_ns, first.gyroscope_bias_rad_s);
  begin_s = std::max(begin_s - options.margin_s, gyro.begin_s());
  end_s = std::min(end_s + options.margin_s, gyro.end_s());
  if (end_s - begin_s < options.least_overlap_s) {
    throw calibrationFailed(imu.name,
                            fmt::format("views and IMU samples overlap for {:.2f} s only", end_s - begin_s),
                            "Record for 30 s with the board in view");
  }
  CalibrationState& state = result.state;
  state.world_from_imu_rotation =
      fitWorldRotation(poses.front(), first, gyro, begin_s, end_s, options.knot_spacing_s);
  context.throwIfStopped();
  const GravityAlignment gravity = alignGravity(poses.front(), first.time_offset_s, imu.samples,
                                                input.start_ns, state.world_from_imu_rotation, options);
  result.steps.push_back({"gravity and translation",
                          fmt::format("positions agree to {:.2f} mm, accelerations to {:.3f} m/s^2",
                                      gravity.position_rms_m * 1e3, gravity.acceleration_rms_m_s2),
                          gravity.position_rms_m, gravity.camera_in_imu_std_m});
  state.imu_in_world_m = gravity.imu_in_world_m;
  state.gravity_in_world_m_s2 = gravity.gravity_in_world_m_s2;
  state.imus.resize(1);
  state.imus.front().gyroscope_bias_rad_s = first.gyroscope_bias_rad_s;
  state.imus.front().accelerometer_bias_m_s2 = gravity.accelerometer_bias_m_s2;
  for (std::size_t k = 0; k < input.cameras.size(); ++k) {
    CameraState camera;
    camera.imu_from_camera = {hand_eyes[k].imu_from_camera, gravity.camera_in_imu_m};
    camera.time_offset_s = hand_eyes[k].time_offset_s;
    state.cameras.push_back(camera);
  }
  context.progress.stageProgress(1.0);
  return result;
}

}  // namespace evical
