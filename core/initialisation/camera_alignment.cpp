#include "core/initialisation/camera_alignment.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/base/time.h"
#include "core/data/unfit_samples.h"
#include "core/initialisation/camera_imu_rotation.h"
#include "core/initialisation/initialisation_checks.h"
#include "core/initialisation/time_offset.h"
#include "core/numerics/angles.h"
#include "core/numerics/robust.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace evical {
namespace {

std::vector<CameraPose> cameraPoses(const CameraData& camera, const Board& board,
                                    const InitialisationOptions& options, const RunContext& context,
                                    Initialisation& result) {
  CameraPoses found = estimateCameraPoses(camera, board, options, context);
  checkViews(camera, found, options);
  result.steps.push_back({nameOf(UsualStep::CameraPoses), camera.name,
                          fmt::format("{} of {} views, points fit to {:.3f} px (median)", found.poses.size(),
                                      camera.observations.views.size(), found.median_reprojection_px),
                          found.median_reprojection_px, 0.0});
  if (found.rejected > static_cast<int>(found.poses.size())) {
    result.warnings.push_back(fmt::format(
        "{}: the points of most views ({} of {}) fit the board with errors above {:.2f} px; check the "
        "intrinsics and the board",
        camera.name, found.rejected, camera.observations.views.size(), options.max_reprojection_px));
  }
  return std::move(found.poses);
}

// Hand-eye calibration from one candidate offset, then again with the poses that agree with the gyroscope.
std::optional<AlignedCamera> align(std::vector<CameraPose> poses, const GyroRotation& gyro,
                                   double time_offset_s, const InitialisationOptions& options,
                                   const SensorPrior& prior) {
  resolveAmbiguousPoses(poses, gyro, time_offset_s, options.max_pair_s);
  const std::optional<RelativeRotation> found =
      estimateCameraImuRotation(poses, gyro, time_offset_s, options, prior);
  if (!found) return std::nullopt;
  return AlignedCamera{std::move(poses), *found};
}

void warnOfPeaks(const CameraData& camera, const std::vector<TimeOffsetPeak>& peaks, double chosen_s,
                 const InitialisationOptions& options, Initialisation& result) {
  const TimeOffsetPeak& best = peaks.front();
  const std::optional<KnownNumber>& known = camera.prior.time_offset;
  if (isGiven(known)) {
    if (best.correlation < options.clear_peak_correlation)
      result.warnings.push_back(fmt::format(
          "{}: rotation rates of camera and gyroscope agree weakly (correlation {:.2f}) at the given "
          "time offset of {:.4f} s; check this offset",
          camera.name, best.correlation, known->value));
  } else if (best.correlation < options.clear_peak_correlation) {
    result.warnings.push_back(fmt::format(
        "{}: the time offset is not clear: rotation rates of camera and gyroscope agree weakly (correlation "
        "{:.2f}); rotate more, or increase initialisation.time_offset_search_s",
        camera.name, best.correlation));
  } else if (peaks.size() > 1 && best.correlation - peaks[1].correlation < options.clear_peak_lead) {
    result.warnings.push_back(fmt::format(
        "{}: the motion nearly repeats itself: time offsets of {:.3f} s and {:.3f} s correlate almost "
        "equally ({:.3f} and {:.3f}), and complete rotations agree with {:.3f} s; move irregularly",
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
    // The more significant peak is kept unless another is better by more than chance.
    if (found && (!best || found->hand_eye.cost < options.better_alignment * best->hand_eye.cost))
      best = std::move(found);
  }
  if (!best) {
    throw calibrationFailed(camera.name, "there are too few pairs of views to estimate the camera's rotation",
                            "Record longer, with the board in view");
  }
  return std::move(*best);
}

// Swaps and drops poses that contradict the gyroscope, and repeats the hand-eye calibration without them.
// True if that is a step of the result; false if too few remain.
bool settlePoses(const CameraData& camera, const ImuData& imu, std::int64_t start_ns,
                 const GyroRotation& gyro, const InitialisationOptions& options, AlignedCamera& aligned,
                 Initialisation& result) {
  constexpr int kRounds = 2;
  int swapped = 0, dropped = 0;
  const std::vector<ImuSample> rates = withoutRateSpikes(imu.samples);
  for (int round = 0; round < kRounds; ++round) {
    const GyroRotation unbiased(rates, start_ns, aligned.hand_eye.gyroscope_bias_rad_s);
    AlignedCamera next = aligned;
    const PoseConsistency consistency = keepConsistentPoses(next.poses, unbiased, next.hand_eye, options);
    const auto again =
        estimateCameraImuRotation(next.poses, gyro, next.hand_eye.time_offset_s, options, camera.prior);
    if (!again || static_cast<int>(next.poses.size()) < options.min_views) {
      result.warnings.push_back(camera.name +
                                ": rotations of camera and gyroscope contradict each other in most views");
      return false;
    }
    next.hand_eye = *again;
    aligned = std::move(next);
    swapped += consistency.swapped;
    dropped += consistency.dropped;
    if (consistency.swapped == 0 && consistency.dropped == 0) break;
  }
  const auto views = static_cast<int>(aligned.poses.size()) + dropped;
  result.steps.push_back({nameOf(UsualStep::PlanarPoses), camera.name,
                          fmt::format("the gyroscope swapped {} views to the plane's other pose and "
                                      "contradicts {} of {}",
                                      swapped, dropped, views),
                          static_cast<double>(dropped) / views, 0.0});
  return true;
}

bool isClear(const std::vector<TimeOffsetPeak>& peaks, const InitialisationOptions& options) {
  return !peaks.empty() && peaks.front().correlation >= options.clear_peak_correlation;
}

InitialisationOptions widest(const std::vector<CameraPose>& poses, const GyroRotation& gyro,
                             const InitialisationOptions& options) {
  constexpr double kMinShare = 0.5;  // chosen: short overlaps can agree by chance
  InitialisationOptions wide = options;
  wide.time_offset_search_s = options.widest_time_offset_search_s;
  wide.min_overlap_s = std::max(
      options.min_overlap_s,
      kMinShare * std::min(poses.back().time_s - poses.front().time_s, gyro.end_s() - gyro.begin_s()));
  return wide;
}

// The offset at which rates agree, however far apart the clocks are: searched around that of the recordings'
// middles.
std::optional<double> offsetOfClocks(const std::vector<CameraPose>& poses, const GyroRotation& gyro,
                                     const InitialisationOptions& options) {
  SensorPrior middles;
  middles.time_offset =
      KnownNumber{0.5 * (gyro.begin_s() + gyro.end_s() - poses.front().time_s - poses.back().time_s),
                  options.widest_time_offset_search_s};
  const std::vector<TimeOffsetPeak> peaks =
      correlateTimeOffset(poses, gyro, widest(poses, gyro, options), middles);
  const bool alone =
      peaks.size() < 2 || peaks[0].correlation - peaks[1].correlation >= options.clear_peak_lead;
  return isClear(peaks, options) && alone ? std::optional(peaks.front().time_offset_s) : std::nullopt;
}

// Throws if camera and IMU do not overlap, as their clocks are.
void checkClocks(const CameraData& camera, const std::string& imu, const std::vector<CameraPose>& poses,
                 const GyroRotation& gyro, const InitialisationOptions& options) {
  const std::optional<KnownNumber>& known = camera.prior.time_offset;
  const double offset_s = known ? known->value : 0.0;
  const double first_s = poses.front().time_s, last_s = poses.back().time_s;
  const double overlap_s =
      std::min(last_s, gyro.end_s() - offset_s) - std::max(first_s, gyro.begin_s() - offset_s);
  if (overlap_s >= options.min_overlap_s) return;
  const bool apart = overlap_s <= 0.0;
  std::string problem = fmt::format(
      "camera and IMU {}: the board is seen from {:.3f} s to {:.3f} s, the IMU has samples from {:.3f} s to "
      "{:.3f} s",
      apart ? "do not overlap in time" : fmt::format("overlap for less than {:.1f} s", options.min_overlap_s),
      first_s, last_s, gyro.begin_s(), gyro.end_s());
  std::string advice = apart ? "Check the clocks" : "Record for 30 s";
  if (isGiven(known)) {
    advice = "Check the clocks, and the time offset " + howTo(HowTo::EditSession);
  } else if (const std::optional<double> found_s = offsetOfClocks(poses, gyro, options)) {
    problem += fmt::format("; their rotations agree if the IMU's clock is {:.3f} s {}", std::abs(*found_s),
                           *found_s > 0.0 ? "ahead" : "behind");
    advice =
        fmt::format("Add {:.3f} to clock_offset_s of {} (0 if it is not given), which is added to its times",
                    -*found_s, imu);
  } else if (apart) {
    advice += fmt::format(
        ": if both recordings began at the same moment, add {:.1f} to clock_offset_s of {} (0 if it is not "
        "given)",
        std::min(first_s, 0.0) - gyro.begin_s(), imu);
  }
  throw calibrationFailed(camera.name, problem, advice);
}

// Peaks within the options' range; if rates do not agree in it, within the widest range. For large offsets,
// short overlaps agree by chance, so that at least half of the data must overlap there.
std::vector<TimeOffsetPeak> timeOffsetPeaks(const CameraData& camera, const std::vector<CameraPose>& poses,
                                            const GyroRotation& gyro, const InitialisationOptions& options,
                                            Initialisation& result) {
  std::vector<TimeOffsetPeak> peaks = correlateTimeOffset(poses, gyro, options, camera.prior);
  if (isClear(peaks, options) || camera.prior.time_offset ||
      options.widest_time_offset_search_s <= options.time_offset_search_s)
    return peaks;
  std::vector<TimeOffsetPeak> further =
      correlateTimeOffset(poses, gyro, widest(poses, gyro, options), camera.prior);
  if (!isClear(further, options)) return peaks;
  if (!peaks.empty() && further.front().significance <= peaks.front().significance) return peaks;
  result.warnings.push_back(
      fmt::format("{}: the time offset exceeds initialisation.time_offset_search_s ({:g} s): it is {:.3f} s",
                  camera.name, options.time_offset_search_s, further.front().time_offset_s));
  return further;
}

}  // namespace

AlignedCamera alignCamera(const CameraData& camera, const CalibrationInput& input, const GyroRotation& gyro,
                          const InitialisationOptions& options, const RunContext& context,
                          Initialisation& result) {
  const ImuData& imu = input.imus[input.reference_imu];
  Stopwatch stopwatch;
  const std::vector<CameraPose> poses =
      cameraPoses(camera, input.boardAt(camera.board), options, context, result);
  result.steps.back().duration_s = stopwatch.restart_s();
  context.throwIfStopped();
  const std::vector<TimeOffsetPeak> peaks = timeOffsetPeaks(camera, poses, gyro, options, result);
  if (!isClear(peaks, options)) checkClocks(camera, imu.name, poses, gyro, options);
  if (peaks.empty()) {
    throw calibrationFailed(camera.name,
                            "too few pairs of views overlap with the gyroscope to estimate the time offset",
                            "Record longer, with the board in view");
  }
  const double offset_s = stopwatch.restart_s();
  AlignedCamera aligned = bestAlignment(camera, poses, peaks, gyro, options, context);
  context.throwIfStopped();
  const double rotation_s = stopwatch.restart_s();
  result.agreements.push_back(
      {camera.name, peaks.front().correlation,
       compareRotations(aligned.poses, gyro, aligned.hand_eye.time_offset_s, options),
       findClockStep(offsetsByParts(aligned.poses, gyro, aligned.hand_eye, options))});
  if (settlePoses(camera, imu, input.start_ns, gyro, options, aligned, result))
    result.steps.back().duration_s = stopwatch.restart_s();
  const RelativeRotation& hand_eye = aligned.hand_eye;
  warnOfPeaks(camera, peaks, hand_eye.time_offset_s, options, result);
  const double next = peaks.size() > 1 ? peaks[1].correlation : 0.0;
  result.steps.push_back(
      {nameOf(UsualStep::TimeOffset), camera.name,
       fmt::format("{:.4f} s, correlation {:.3f}, peak {:.0f} ms wide, next best {:.3f}",
                   hand_eye.time_offset_s, peaks.front().correlation, peaks.front().width_s * 1e3, next),
       1.0 - peaks.front().correlation, peaks.front().correlation - next, offset_s});
  result.steps.push_back(
      {nameOf(UsualStep::CameraImuRotation), camera.name,
       fmt::format("{} pairs agree to {:.3f} deg, second axis {:.2f} of the first", hand_eye.pairs,
                   hand_eye.residual_rad * kDegPerRad, hand_eye.axis_ratio),
       hand_eye.residual_rad, hand_eye.axis_ratio, rotation_s});
  return aligned;
}

namespace {

constexpr double kMaxNeighbours = 120.0;  // enough for a vote
// Mirrored poses agree with each other for a while, as long as the viewing direction is constant; since their
// circles fit worse, they have a lower weight.
constexpr double kSecondChoice = 0.5;

// world_from_first by either pose of one view.
struct Carried {
  Eigen::Quaterniond first, second;
  bool has_second = false;
};

double angle(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return 2.0 * std::acos(std::min(1.0, std::abs(a.dot(b))));
}

struct Vote {
  int neighbours = 0;
  double for_first = 0.0, for_second = 0.0;
};

Vote voteOn(const std::vector<Carried>& carried, const std::vector<CameraPose>& poses, std::size_t k,
            double min_cosine, double window_s) {
  const auto agreement = [&](const Eigen::Quaterniond& a, const Carried& other) {
    if (std::abs(a.dot(other.first)) > min_cosine) return 1.0;
    return other.has_second && std::abs(a.dot(other.second)) > min_cosine ? kSecondChoice : 0.0;
  };
  const auto earlier = [](const CameraPose& pose, double time_s) { return pose.time_s < time_s; };
  const auto begin =
      std::lower_bound(poses.begin(), poses.end(), poses[k].time_s - window_s, earlier) - poses.begin();
  const auto end =
      std::lower_bound(poses.begin(), poses.end(), poses[k].time_s + window_s, earlier) - poses.begin();
  const double stride = std::max(1.0, static_cast<double>(end - begin) / kMaxNeighbours);
  Vote vote;
  for (auto position = static_cast<double>(begin); position < static_cast<double>(end); position += stride) {
    const auto n = static_cast<std::size_t>(position);
    if (n == k) continue;
    ++vote.neighbours;
    vote.for_first += agreement(carried[k].first, carried[n]);
    if (carried[k].has_second) vote.for_second += agreement(carried[k].second, carried[n]);
  }
  return vote;
}

double medianStep(const std::vector<CameraPose>& poses, const GyroRotation& gyro,
                  const RelativeRotation& hand_eye) {
  std::vector<double> steps;
  std::optional<Eigen::Quaterniond> before;
  for (const CameraPose& pose : poses) {
    const Eigen::Quaterniond here = pose.world_from_camera.rotation *
                                    hand_eye.reference_from_sensor.conjugate() *
                                    gyro.at(pose.time_s + hand_eye.time_offset_s).conjugate();
    if (before) steps.push_back(angle(*before, here));
    before = here;
  }
  return medianOf(std::move(steps));
}

}  // namespace

PoseConsistency keepConsistentPoses(std::vector<CameraPose>& poses, const GyroRotation& gyro,
                                    const RelativeRotation& hand_eye, const InitialisationOptions& options) {
  const double min_cosine = std::cos(0.5 * options.max_rotation_disagreement_rad);
  std::vector<Carried> carried;
  for (const CameraPose& pose : poses) {
    const Eigen::Quaterniond back = hand_eye.reference_from_sensor.conjugate() *
                                    gyro.at(pose.time_s + hand_eye.time_offset_s).conjugate();
    Carried c{pose.world_from_camera.rotation * back, Eigen::Quaterniond::Identity()};
    c.has_second = pose.other_world_from_camera.has_value();
    if (c.has_second) c.second = pose.other_world_from_camera->rotation * back;
    carried.push_back(c);
  }
  PoseConsistency result;
  std::vector<CameraPose> kept;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double time_s = poses[k].time_s + hand_eye.time_offset_s;
    const Vote vote = voteOn(carried, poses, k, min_cosine, options.agreement_window_s);
    // Outside the gyroscope's samples, or without neighbours, no decision is possible.
    const bool judged = gyro.covers(time_s, time_s) && vote.neighbours > 0;
    if (judged && std::max(vote.for_first, vote.for_second) < options.min_agreement * vote.neighbours) {
      ++result.dropped;
      continue;
    }
    kept.push_back(poses[k]);
    if (judged && vote.for_second > vote.for_first) {
      std::swap(kept.back().world_from_camera, *kept.back().other_world_from_camera);
      ++result.swapped;
    }
  }
  poses = std::move(kept);
  result.usual_rad = medianStep(poses, gyro, hand_eye);
  return result;
}

}  // namespace evical
