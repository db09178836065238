#include "core/initialisation/initialisation_checks.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/base/number.h"
#include "core/data/unfit_samples.h"
#include "core/initialisation/knot_spacing.h"
#include "core/initialisation/time_offset.h"
#include "core/numerics/robust.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace evical {

void checkInput(const CalibrationInput& input, const InitialisationOptions& options) {
  if (options.knot_spacing_s > 0.0 && options.knot_spacing_s < kClosestKnots_s) {
    throw badInput("initialisation.knot_spacing_s",
                   fmt::format("{:g} s is too small", options.knot_spacing_s),
                   fmt::format("Give at least {:g} s, or 0 to adapt knots to the motion", kClosestKnots_s));
  }
  for (std::size_t i = 0; i < input.boardCount(); ++i) {
    if (!input.boardAt(i).hasHalfTurnAmbiguity()) continue;
    throw badInput(input.boardKey(i), "is unchanged by half a turn, so its pose is ambiguous",
                   "Use an asymmetric board with an odd number of rows, or this one for intrinsics only");
  }
  if (input.cameras.empty())
    throw calibrationFailed("session", "there is no camera", "Add one under the key cameras");
  if (input.cameras[input.worldCamera()].board != 0)
    throw badInput("boards",
                   fmt::format("{} does not see the first board, whose frame is the world",
                               input.cameras[input.worldCamera()].name),
                   "List the board first that this camera sees");
  for (const CameraData& camera : input.cameras) {
    if (!camera.lens.detection_intrinsics)
      throw calibrationFailed(camera.name, "has no intrinsics", "Specify them " + howTo(HowTo::EditSession));
  }
  if (input.imus.empty() && input.cameras.size() == 1) {
    throw calibrationFailed("session", "there is neither an IMU nor a second camera",
                            "Add one: a single camera cannot be calibrated relative to another sensor");
  }
  for (const ImuData& imu : input.imus) {
    const std::size_t usable =
        std::min(withoutRateSpikes(imu.samples).size(), withFitForces(imu.samples).size());
    if (usable >= static_cast<std::size_t>(options.min_imu_samples)) continue;
    throw calibrationFailed(imu.name, "has only " + counted(usable, "usable sample"),
                            "Check the IMU's stream, and record for 30 s");
  }
}

void checkTurnsWithCamera(const CalibrationInput& input, const ImuData& imu, const GyroRotation& gyro,
                          const InitialisationOptions& options, const RunContext& context) {
  const double imu_rad_s = gyro.rateRms_rad_s();
  if (imu_rad_s >= options.min_rotation_rate_rad_s) return;
  const CameraData& camera = input.cameras.front();
  const CameraPoses found = estimateCameraPoses(camera, input.boardAt(camera.board), options, context);
  std::vector<double> rates_rad_s;
  for (const RatePair& pair : ratePairs(found.poses, options.pair_gap_s, options.max_pair_s))
    rates_rad_s.push_back(pair.rate_rad_s);
  if (static_cast<int>(found.poses.size()) < options.min_views || rates_rad_s.empty()) return;
  const double camera_rad_s = medianOf(std::move(rates_rad_s));
  if (camera_rad_s < options.turning_camera_ratio * std::max(imu_rad_s, options.min_rotation_rate_rad_s))
    return;
  throw calibrationFailed(
      imu.name,
      fmt::format(
          "the IMU is at rest while {} turns: its rate is {:.4f} rad/s RMS, the camera's {:.2g} rad/s",
          camera.name, imu_rad_s, camera_rad_s),
      "Fix the IMU and the camera to each other, and check that the files belong together");
}

void checkGyroscope(const ImuData& imu, const GyroRotation& gyro, const InitialisationOptions& options,
                    std::vector<std::string>& warnings) {
  const double rate_rad_s = gyro.rateRms_rad_s();
  if (rate_rad_s < options.min_rotation_rate_rad_s) {
    throw calibrationFailed(
        imu.name, fmt::format("the rig hardly moves: the gyroscope's rate is {:.4f} rad/s RMS", rate_rad_s),
        "Rotate the rig about all three axes while the board is in view");
  }
  double gap_begin_s = 0.0;
  const double gap_s = gyro.longestGap_s(&gap_begin_s);
  if (gap_s > options.max_imu_gap_s) {
    warnings.push_back(
        fmt::format("{}: no samples for {:.3f} s from {:.3f} s on; the motion there is extrapolated",
                    imu.name, gap_s, gap_begin_s));
  }
}

void checkViews(const CameraData& camera, const CameraPoses& found, const InitialisationOptions& options) {
  const std::size_t views = camera.observations.views.size();
  if (static_cast<int>(views) < options.min_views) {
    throw calibrationFailed(
        camera.name,
        fmt::format("the board was detected in {} of {} event windows or frames, but {} are needed", views,
                    camera.observations.windows.size(), options.min_views),
        "Check the detections " + howTo(HowTo::LookAtDetections) +
            " and the board's rows and columns, and keep the board in view");
  }
  if (static_cast<int>(found.poses.size()) < options.min_views) {
    throw calibrationFailed(
        camera.name,
        fmt::format("the points fit the board in {} of {} views, but {} are needed; the median error is "
                    "{:.2f} px (at most {:.2f} px is allowed)",
                    found.poses.size(), views, options.min_views, found.median_reprojection_px,
                    options.max_reprojection_px),
        "Check the intrinsics, and the board's rows, columns, spacing and radius");
  }
}

void checkOverlap(const ImuData& imu, double views_begin_s, double views_end_s, double begin_s, double end_s,
                  const InitialisationOptions& options) {
  const double overlap_s = std::min(views_end_s, end_s) - std::max(views_begin_s, begin_s);
  if (overlap_s >= options.min_overlap_s) return;
  throw calibrationFailed(
      imu.name,
      fmt::format(
          "views and IMU samples overlap for only {:.2f} s: the board is seen from {:.3f} s to {:.3f} s "
          "on the IMU's clock, the IMU has samples from {:.3f} s to {:.3f} s",
          std::max(overlap_s, 0.0), views_begin_s, views_end_s, begin_s, end_s),
      "Record for 30 s with the board in view");
}

}  // namespace evical
