#include "core/initialisation/initialise.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/data/calibration_observer.h"
#include "core/data/unfit_samples.h"
#include "core/initialisation/additional_imus.h"
#include "core/initialisation/agreement_check.h"
#include "core/initialisation/camera_alignment.h"
#include "core/initialisation/camera_only_initialisation.h"
#include "core/initialisation/further_boards.h"
#include "core/initialisation/gravity_alignment.h"
#include "core/initialisation/initialisation_checks.h"
#include "core/initialisation/knot_spacing.h"
#include "core/initialisation/world_rotation.h"

#include "core/geometry/so3.h"
#include "core/numerics/angles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace evical {
namespace {

const ImuData& referenceImu(const CalibrationInput& input) {
  return input.imus[input.reference_imu];
}

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
  for (const AlignedCamera& camera : cameras)
    tracks.push_back(
        {camera.poses, camera.hand_eye.time_offset_s, input.cameras[camera.camera].prior.translation});
  return tracks;
}

// If the rotation is about one axis only, accelerations determine the camera's angle about it.
void turnAboutAxis(const CalibrationInput& input, const InitialisationOptions& options, TimeRange range,
                   const GyroRotation& gyro, const RunContext& context, std::vector<AlignedCamera>& cameras,
                   Initialisation& result) {
  RelativeRotation& first = cameras.front().hand_eye;
  if (first.axis_ratio >= options.min_axis_ratio) return;
  result.warnings.push_back(input.cameras.front().name +
                            ": the recording rotates about one axis only: rotate about two more");
  if (isGiven(input.cameras.front().prior.rotation)) return;
  // The angle does not need closely spaced knots.
  constexpr double kMinKnot_s = 0.05;
  const double knot_s = std::max(options.knot_spacing_s, kMinKnot_s);
  const So3Spline rotation = fitWorldRotation({cameras.data(), 1}, gyro, range.begin_s, range.end_s, knot_s);
  const double turn_rad = findTurnAboutAxis(first.main_axis_in_imu, tracksOf(input, cameras),
                                            withFitForces(referenceImu(input).samples), input.start_ns,
                                            rotation, options, context);
  for (AlignedCamera& camera : cameras) {
    camera.hand_eye.reference_from_sensor =
        quaternionExp(-turn_rad * first.main_axis_in_imu) * camera.hand_eye.reference_from_sensor;
  }
}

// Knot spacing of both splines: that of the sensor that needs the closest knots. Separate spacings would save
// control points of one spline, but widen the band of the normal equations, so that nothing is gained.
double commonKnotSpacing_s(const CalibrationInput& input, const InitialisationOptions& options,
                           const std::vector<AlignedCamera>& cameras, TimeRange range,
                           const GyroRotation& reference, Initialisation& result) {
  if (options.knot_spacing_s > 0.0) return options.knot_spacing_s;
  Stopwatch stopwatch;
  const ViewPrecision views = viewPrecision(input.cameras, cameras);
  const ImuData* asking = &referenceImu(input);
  KnotSpacing asked = knotSpacing(*asking, input.start_ns, range, reference, views);
  const double closest_s = closestKnots_s(*asking);
  for (const ImuData& imu : input.imus) {
    if (&imu == &referenceImu(input)) continue;
    const GyroRotation own(withoutRateSpikes(imu.samples), input.start_ns);
    const KnotSpacing other = knotSpacing(imu, input.start_ns, range, own, views);
    if (other.spacing_s() >= asked.spacing_s()) continue;
    asking = &imu;
    asked = other;
  }
  const double spacing_s = std::max(asked.spacing_s(), closest_s);
  result.steps.push_back(
      {"knot spacing", "", describe(asking->name, asked, spacing_s), 0.0, 0.0, stopwatch.restart_s()});
  return spacing_s;
}

// A last segment with few measurements would not determine its outermost control points.
double endOfWholeKnots_s(TimeRange range, double knot_s) {
  constexpr double kMinShare = 0.75;  // more than the batch requires, as delays and offsets move samples
  const double knots = (range.end_s - range.begin_s) / knot_s;
  const double whole = std::floor(knots);
  return whole < 1.0 || knots - whole >= kMinShare ? range.end_s : range.begin_s + whole * knot_s;
}

void checkBoardScale(const GravityAlignment& gravity, const Board& board,
                     const InitialisationOptions& options, Initialisation& result) {
  const double excess = gravity.board_scale - 1.0, sigma = gravity.board_scale_std;
  result.steps.push_back(
      {"board scale", "",
       fmt::format("according to accelerations, the board is {:.3f} +- {:.3f} times as large as given",
                   gravity.board_scale, sigma),
       std::abs(excess), sigma});
  if (std::abs(excess) < options.max_scale_error || std::abs(excess) < options.scale_error_sigmas * sigma)
    return;
  result.doubt = fmt::format(
      "the board seems {:.0f} % {} than specified (spacing {:.4g} m): measure it; accelerations "
      "agree with a spacing of {:.3g} m",
      100.0 * std::abs(excess), excess > 0.0 ? "larger" : "smaller", board.spacing_m,
      gravity.board_scale * board.spacing_m);
  result.warnings.push_back(result.doubt);
}

// Board scale and misfit of the accelerations if the scale is far from 1: positions from views are scaled
// until it no longer changes, since their noise would bias it. False if it does not settle: something else is
// wrong.
bool refineBoardScale(std::vector<CameraTrack> tracks, const CalibrationInput& input,
                      const So3Spline& rotation, const InitialisationOptions& options,
                      const RunContext& context, GravityAlignment& gravity) {
  constexpr int kMaxRounds = 6;
  constexpr double kMin = 1e-3;
  double step = gravity.board_scale, scale = 1.0;
  const bool far = step > options.wrong_size_ratio || step < 1.0 / options.wrong_size_ratio;
  if (!far || std::abs(step - 1.0) < options.scale_error_sigmas * gravity.board_scale_std) return true;
  for (int round = 0; round < kMaxRounds && step > kMin; ++round) {
    for (CameraTrack& track : tracks)
      for (CameraPose& pose : track.poses) pose.world_from_camera.translation_m *= step;
    const GravityAlignment again = alignGravity(tracks, withFitForces(referenceImu(input).samples),
                                                input.start_ns, rotation, options, context);
    scale *= step;
    step = again.board_scale;
    if (std::abs(step - 1.0) > options.settled_size) continue;
    gravity.board_scale = scale * step;
    gravity.board_scale_std = scale * again.board_scale_std;
    gravity.acceleration_misfit_m_s2 = again.acceleration_misfit_m_s2;
    return true;
  }
  return false;
}

// From the cameras that see the world's board; `all` cameras show which sign is wrong.
void alignTranslations(const CalibrationInput& input, const StatedSigns& stated,
                       const InitialisationOptions& options, const std::vector<AlignedCamera>& cameras,
                       const std::vector<AlignedCamera>& all, const GyroRotation& gyro,
                       const RunContext& context, Initialisation& result) {
  CalibrationState& state = result.state;
  Stopwatch stopwatch;
  GravityAlignment gravity =
      alignGravity(tracksOf(input, cameras), withFitForces(referenceImu(input).samples), input.start_ns,
                   state.world_from_imu_rotation, options, context);
  const bool settled = refineBoardScale(tracksOf(input, cameras), input, state.world_from_imu_rotation,
                                        options, context, gravity);
  result.steps.push_back(
      {nameOf(UsualStep::GravityAndTranslation), "",
       fmt::format("positions agree to {:.2f} mm in {} of {} views, accelerations to {:.3f} m/s^2",
                   gravity.position_rms_m * 1e3, gravity.views - gravity.outlying_views, gravity.views,
                   gravity.acceleration_rms_m_s2),
       gravity.position_rms_m, gravity.lever_std_m, stopwatch.restart_s()});
  if (gravity.outlying_views > 0) {
    result.warnings.push_back(fmt::format(
        "{} of {} views contradict their neighbours and the IMU on the camera's position: the board was "
        "probably misidentified",
        gravity.outlying_views, gravity.views));
  }
  checkAccelerationsAgree(input, stated, all, gyro, gravity, options, context);
  result.forces_show_size = gravity.board_scale > options.scale_error_sigmas * gravity.board_scale_std;
  checkBoardScale(gravity, input.board, options, result);
  if (settled && !result.doubt.empty()) result.board_scale = gravity.board_scale;
  state.imu_in_world_m = gravity.imu_in_world_m;
  state.gravity_in_world_m_s2 = gravity.gravity_in_world_m_s2;
  state.imus.resize(input.imus.size());
  state.cameras.resize(input.cameras.size());
  ImuState& reference = state.imus[input.reference_imu];
  reference.gyroscope_bias_rad_s = cameras.front().hand_eye.gyroscope_bias_rad_s;
  reference.accelerometer_bias_m_s2 = gravity.accelerometer_bias_m_s2;
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    CameraState& camera = state.cameras.at(cameras[k].camera);
    camera.reference_from_camera = {cameras[k].hand_eye.reference_from_sensor, gravity.cameras_in_imu_m[k]};
    camera.time_offset_s = cameras[k].hand_eye.time_offset_s;
  }
}

void alignFurtherImu(const CalibrationInput& input, std::size_t k, const GyroRotation& reference,
                     const InitialisationOptions& options, const RunContext& context,
                     Initialisation& result) {
  const ImuData& imu = input.imus[k];
  Stopwatch stopwatch;
  const ImuRotation rotation = alignFurtherGyroscope(imu, input.start_ns, reference, options, context);
  if (forcesOppose(referenceImu(input), imu, rotation.hand_eye.reference_from_sensor,
                   rotation.hand_eye.time_offset_s))
    throw calibrationFailed(imu.name,
                            "the accelerations are negated relative to those of " + referenceImu(input).name,
                            "Change their sign (at rest, an accelerometer measures +g upwards)")
        .repairedBy(Repair{"imus." + imu.name + ".accelerometer_axes", "-x,-y,-z"});
  const LeverArm lever = solveLeverArm(imu, input.start_ns, rotation, result.state, options);
  const RelativeRotation& hand_eye = rotation.hand_eye;
  ImuState& state = result.state.imus[k];
  state.reference_from_imu = {hand_eye.reference_from_sensor, lever.imu_in_reference_m};
  state.time_offset_s = hand_eye.time_offset_s;
  state.gyroscope_bias_rad_s = hand_eye.gyroscope_bias_rad_s;
  state.accelerometer_bias_m_s2 = lever.accelerometer_bias_m_s2;
  result.steps.push_back(
      {"IMU to IMU", imu.name,
       fmt::format(
           "time offset {:.4f} s (correlation {:.3f}), rotations agree to {:.3f} deg, accelerations to "
           "{:.3f} m/s^2",
           hand_eye.time_offset_s, rotation.correlation, hand_eye.residual_rad * kDegPerRad,
           lever.force_rms_m_s2),
       hand_eye.residual_rad, lever.std_m, stopwatch.restart_s()});
}

// Reports new steps to the observer.
void reportSteps(const std::vector<InitialisationStep>& steps, CalibrationObserver* observer,
                 std::size_t& reported) {
  for (; observer != nullptr && reported < steps.size(); ++reported)
    observer->initialisationStepDone(steps[reported].name, steps[reported].subject, steps[reported].result,
                                     steps[reported].duration_s);
}

void keepLenses(const CalibrationInput& input, CalibrationState& state) {
  for (std::size_t k = 0; k < input.cameras.size(); ++k) state.cameras[k].lens = input.cameras[k].lens;
}

// The gyroscopes' samples in the axes of the IMUs, if their rotation is known.
CalibrationInput withStraightGyroscopes(CalibrationInput input) {
  for (ImuData& imu : input.imus) {
    if (!imu.prior.gyroscope_rotation) continue;
    const Eigen::Quaterniond straight = imu.prior.gyroscope_rotation->value.conjugate();
    for (ImuSample& sample : imu.samples) sample.angular_rate_rad_s = straight * sample.angular_rate_rad_s;
  }
  return input;
}

bool saturates(const ImuData& imu) {
  const UnfitSamples unfit = findUnfitSamples(imu.samples);
  return std::any_of(kImuAxes.begin(), kImuAxes.end(), [&](const ImuAxis& axis) {
    return axis.rate && !unfit.saturated[static_cast<std::size_t>(&axis - kImuAxes.data())].empty();
  });
}

// Moves cameras that see other boards than the world's to the returned map.
std::map<std::size_t, AlignedCamera> takeFurther(const CalibrationInput& input,
                                                 std::vector<AlignedCamera>& cameras) {
  std::map<std::size_t, AlignedCamera> further;
  for (AlignedCamera& camera : cameras)
    if (input.cameras[camera.camera].board > 0) further.emplace(camera.camera, std::move(camera));
  std::erase_if(cameras, [&](const AlignedCamera& camera) { return further.contains(camera.camera); });
  return further;
}

// Trajectory of the body, known at the times of views of the world's board.
CameraTrajectory bodyTrajectory(const std::vector<AlignedCamera>& cameras, const CalibrationState& state) {
  CameraTrajectory body{state.world_from_imu_rotation, state.imu_in_world_m, {}};
  for (const AlignedCamera& camera : cameras)
    for (const CameraPose& pose : camera.poses)
      body.view_times_s.push_back(pose.time_s + camera.hand_eye.time_offset_s);
  std::sort(body.view_times_s.begin(), body.view_times_s.end());
  return body;
}

// Each camera's poses, time offset and rotation relative to the reference IMU, independent of the board that
// it sees.
std::vector<AlignedCamera> alignCameras(const CalibrationInput& input, const StatedSigns& stated,
                                        const GyroRotation& gyro, const InitialisationOptions& options,
                                        const RunContext& context, std::size_t& reported,
                                        Initialisation& result) {
  std::vector<AlignedCamera> cameras;
  for (const CameraData& camera : input.cameras) {
    context.throwIfStopped();
    cameras.push_back(alignCamera(camera, input, gyro, options, context, result));
    cameras.back().camera = cameras.size() - 1;
    // A given offset may be the error; it is reported later, with the recording's estimate.
    if (!isGiven(camera.prior.time_offset))
      checkRotationsAgree(input, result.agreements.back(), options, context);
    checkGivenRotation(input, stated, cameras.back(), gyro, options);
    reportSteps(result.steps, context.observer, reported);
    constexpr double kShare = 0.7;
    context.progress.stageProgress(kShare * static_cast<double>(cameras.size()) /
                                   static_cast<double>(input.cameras.size()));
  }
  return cameras;
}

std::vector<AlignedCamera> withFurther(std::vector<AlignedCamera> cameras,
                                       const std::map<std::size_t, AlignedCamera>& further) {
  for (const auto& [index, camera] : further) cameras.push_back(camera);
  return cameras;
}

// Throws CalibrationFailed if one of two cameras that see the same board has a mirrored image.
void checkHandedness(const CalibrationInput& input, const StatedSigns& stated,
                     const std::vector<AlignedCamera>& cameras,
                     const std::map<std::size_t, AlignedCamera>& further, const GyroRotation& gyro,
                     const InitialisationOptions& options, const RunContext& context) {
  if (input.cameras.size() < 2) return;
  const std::vector<AlignedCamera> all = withFurther(cameras, further);
  for (auto camera = all.begin() + 1; camera != all.end(); ++camera) {
    const std::size_t board = input.cameras[camera->camera].board;
    const AlignedCamera& first = *std::ranges::find_if(
        all, [&](const AlignedCamera& each) { return input.cameras[each.camera].board == board; });
    if (!contradictsHandedness(first, *camera, gyro, std::numeric_limits<double>::infinity(), options))
      continue;
    const auto cause = findMirror(input, stated, all, gyro, false, options, context);
    throw MirrorError(cause ? *cause : mirroredOfTwo(input, stated, first, *camera));
  }
}

// Boards other than the world's. If one does not fit, a mirrored image may be the cause.
void alignFurther(const CalibrationInput& input, const StatedSigns& stated,
                  const std::vector<AlignedCamera>& cameras,
                  const std::map<std::size_t, AlignedCamera>& further, const std::vector<AlignedCamera>& all,
                  const GyroRotation& gyro, const InitialisationOptions& options, const RunContext& context,
                  Initialisation& result) {
  constexpr double kCarried_s = 0.3;  // longest time that the IMU bridges between views of the world's board
  try {
    alignFurtherBoards(input, further, bodyTrajectory(cameras, result.state), kCarried_s, options, result);
  } catch (const CalibrationError&) {
    const auto mirror = findMirror(input, stated, all, gyro, false, options, context);
    if (mirror) throw MirrorError(*mirror);
    throw;
  }
}

Initialisation initialiseStraight(const CalibrationInput& input, const StatedSigns& stated,
                                  const InitialisationOptions& options, const RunContext& context) {
  Initialisation result;
  std::size_t reported = 0;
  checkInput(input, options);
  if (input.imus.empty()) {
    initialiseCamerasAlone(input, stated, options, context, result);
    keepLenses(input, result.state);
    reportSteps(result.steps, context.observer, reported);
    context.progress.stageProgress(1.0);
    return result;
  }
  const ImuData& imu = referenceImu(input);
  const std::vector<ImuSample> rates = withoutRateSpikes(imu.samples);
  const GyroRotation gyro(rates, input.start_ns);
  checkTurnsWithCamera(input, imu, gyro, options, context);
  checkGyroscope(imu, gyro, options, result.warnings);
  std::vector<AlignedCamera> cameras = alignCameras(input, stated, gyro, options, context, reported, result);
  const TimeRange views = viewRange(cameras);
  checkOverlap(imu, views.begin_s, views.end_s, gyro.begin_s(), gyro.end_s(), options);
  TimeRange range{std::max(views.begin_s - options.margin_s, gyro.begin_s()),
                  std::min(views.end_s + options.margin_s, gyro.end_s())};
  const std::map<std::size_t, AlignedCamera> before_further = takeFurther(input, cameras);
  const GyroRotation unbiased(rates, input.start_ns, cameras.front().hand_eye.gyroscope_bias_rad_s);
  checkHandedness(input, stated, cameras, before_further, unbiased, options, context);
  turnAboutAxis(input, options, range, unbiased, context, cameras, result);
  context.throwIfStopped();
  const double knot_s = commonKnotSpacing_s(input, options, cameras, range, unbiased, result);
  range.end_s = endOfWholeKnots_s(range, knot_s);
  result.state.world_from_imu_rotation =
      fitWorldRotation(cameras, unbiased, range.begin_s, range.end_s, knot_s,
                       saturates(imu) ? kSaturatedDriftKnot_s : kDriftKnot_s);
  context.throwIfStopped();
  const std::vector<AlignedCamera> all = withFurther(cameras, before_further);
  alignTranslations(input, stated, options, cameras, all, unbiased, context, result);
  alignFurther(input, stated, cameras, before_further, all, unbiased, options, context, result);
  keepLenses(input, result.state);
  for (std::size_t k = 0; k < input.imus.size(); ++k) {
    if (k != input.reference_imu) alignFurtherImu(input, k, unbiased, options, context, result);
  }
  result.mirror_doubt = mirrorDoubt(input, stated, all, result.state, result.forces_show_size);
  reportSteps(result.steps, context.observer, reported);
  context.progress.stageProgress(1.0);
  return result;
}

}  // namespace

Initialisation initialise(const CalibrationInput& input, const InitialisationOptions& options,
                          const RunContext& context, const StatedSigns& stated) {
  const bool turned = std::any_of(input.imus.begin(), input.imus.end(), [](const ImuData& imu) {
    return imu.prior.gyroscope_rotation.has_value();
  });
  if (!turned) return initialiseStraight(input, stated, options, context);
  Initialisation result = initialiseStraight(withStraightGyroscopes(input), stated, options, context);
  for (std::size_t k = 0; k < input.imus.size(); ++k) {
    if (!input.imus[k].prior.gyroscope_rotation) continue;
    const Eigen::Quaterniond& turn = input.imus[k].prior.gyroscope_rotation->value;
    ImuState& imu = result.state.imus[k];
    imu.gyroscope_from_accelerometer = turn;
    imu.gyroscope_bias_rad_s = turn * imu.gyroscope_bias_rad_s;
  }
  return result;
}

}  // namespace evical
