#include "core/pipeline/lens/intrinsics_calibration.h"

#include "core/pipeline/lens/intrinsics_bootstrap.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/data/calibration_observer.h"
#include "core/data/quantity.h"
#include "core/frontend/detection_options.h"
#include "core/geometry/projection_difference.h"
#include "core/intrinsics/estimate_intrinsics.h"
#include "core/intrinsics/intrinsics_checks.h"
#include "core/intrinsics/intrinsics_options.h"
#include "core/intrinsics/intrinsics_uncertainty.h"
#include "core/pipeline/detection/board_size_check.h"
#include "core/pipeline/detection/camera_views.h"
#include "core/pipeline/detection/session_recording.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>
#include <vector>

namespace evical {
namespace {

// Largest motion of refitted centres relative to the change of the lens. A change c that grows with the third
// power of the distance from the image centre, up to L, deforms a circle of radius r so that its ellipse's
// centre moves by about c (r / L)^2; r is at most L / 7.
constexpr double kRefitShare = 0.02;

Session cameraAlone(const Session& session, std::size_t camera) {
  Session alone = session;
  alone.cameras = {session.cameras[camera]};
  alone.cameras.front().intrinsics.reset();
  alone.cameras.front().same_sensor_as.clear();
  alone.cameras.front().board.clear();
  alone.board = session.boardOf(camera);
  alone.further_boards.clear();
  alone.imus.clear();
  alone.reference = alone.cameras.front().name;
  if (!alone.time_range_s) return alone;
  // Times count from the first event or sample of all sensors.
  const double later_s =
      secondsSince(SessionRecording(session).start_ns(), SessionRecording(alone).start_ns());
  for (double& time_s : *alone.time_range_s) time_s -= later_s;
  return alone;
}

// A wrong board size can cause any failure, so it is reported first.
IntrinsicsResult estimate(const Session& alone, const DetectionResult& detections,
                          const std::optional<CameraIntrinsics>& start, const RunContext& context,
                          IntrinsicsStory& story) {
  const BoardObservations& observations = detections.cameras.front();
  try {
    return estimateIntrinsics({alone.board, detections.resolutions_px.front(), observations,
                               detections.lenses.front().detection_intrinsics, start},
                              *alone.options.intrinsics, context, &story);
  } catch (const CalibrationError&) {
    checkBoardSize(observations, alone.board, alone.options.front_end->extent);
    throw;
  }
}

// Appends the views of the second pass to those of the first.
void append(DetectionResult&& more, DetectionResult& detections) {
  constexpr double kBetween_s = 1.0;
  BoardObservations &all = detections.cameras.front(), &added = more.cameras.front();
  if (more.resolutions_px != detections.resolutions_px)
    throw badInput(all.camera, "its recordings have different resolutions", "Give recordings of one camera");
  const double later_s = all.windows.empty() ? 0.0 : all.windows.back().time_s + kBetween_s;
  for (WindowReport& window : added.windows) window.time_s += later_s;
  for (BoardView& view : added.views) {
    view.time_s += later_s;
    for (CircleObservation& point : view.circles) point.time_s += later_s;
  }
  all.events += added.events;
  all.windows.insert(all.windows.end(), added.windows.begin(), added.windows.end());
  all.views.insert(all.views.end(), added.views.begin(), added.views.end());
  detections.faults.insert(detections.faults.end(), more.faults.begin(), more.faults.end());
}

// One recording after the other; recordings without blinking are reported and excluded if others blink.
DetectionResult passOver(const Session& alone, const RunContext& context) {
  std::optional<DetectionResult> all;
  std::optional<CalibrationError> failure;
  std::vector<std::filesystem::path> recordings = alone.more_recordings;
  recordings.insert(recordings.begin(), alone.recording);
  for (const std::filesystem::path& recording : recordings) {
    Session one = alone;
    one.recording = recording;
    one.more_recordings.clear();
    try {
      DetectionResult detections = readAndDetect(one, {CameraLens{}}, context);
      if (all)
        append(std::move(detections), *all);
      else
        all = std::move(detections);
    } catch (const CalibrationError& error) {
      if (error.kind() == ErrorKind::BadInput || recordings.size() == 1) throw;
      context.progress.log(LogLevel::Warning,
                           fmt::format("{}: {}", recording.filename().string(), error.what()));
      if (!failure) failure = error;
    }
  }
  if (!all) throw CalibrationError(*failure);
  return std::move(*all);
}

void reportPass(const IntrinsicsRun& run, const RunContext& context) {
  if (context.observer != nullptr) context.observer->intrinsicsPassDone(run.result.passes, run.result);
}

// Frames, points and flashes are measured in raw pixels, independent of the lens: one pass is enough.
IntrinsicsRun fromSensorPixels(const Session& alone, const RunContext& context) {
  context.progress.stageStarted(nameOf(CalibrationStage::Intrinsics));
  IntrinsicsRun run;
  run.detections = passOver(alone, context);
  if (alone.board_blinks && run.detections.cameras.front().kind == CameraKind::Events)
    checkBlinkingBoardSeen(run.detections.cameras.front(), alone.board);
  checkBoardSeen(run.detections.cameras.front(), alone.board, run.detections.faults);
  run.result = estimate(alone, run.detections, {}, context, run.story);
  run.result.passes = 1;
  reportPass(run, context);
  return run;
}

IntrinsicsRun fromEvents(const Session& alone, const RunContext& context) {
  context.progress.stageStarted(nameOf(CalibrationStage::FirstLook));
  CameraLens lens;
  lens.detection_intrinsics = bootstrapIntrinsics(alone, context);
  IntrinsicsRun run;
  std::optional<CameraIntrinsics> start;
  for (int number = 1; number <= alone.options.intrinsics->max_passes; ++number) {
    context.progress.stageStarted(nameOf(CalibrationStage::Intrinsics));
    run.detections = readAndDetect(alone, {lens}, context);
    if (run.detections.cameras.front().views.empty())
      if (const std::optional<CalibrationError> blink = unexpectedBlink(alone, 0))
        throw CalibrationError(*blink);
    checkBoardSeen(run.detections.cameras.front(), alone.board, run.detections.faults);
    std::vector<TriedModel> tried = std::move(run.story.tried);
    run.result = estimate(alone, run.detections, start, context, run.story);
    if (start) run.story.tried = std::move(tried);
    run.result.passes = number;
    const CameraIntrinsics found = run.result.intrinsics;
    const auto moved = lens.detection_intrinsics
                           ? std::optional(projectionDifference(found, *lens.detection_intrinsics))
                           : std::nullopt;
    lens.detection_intrinsics = start = found;
    if (moved) run.result.moved_px = moved->rms_px;
    reportPass(run, context);
    if (!moved) continue;
    context.progress.log(LogLevel::Debug, fmt::format("pass {}: {} views, changed by {:.4f} px", number,
                                                      run.result.views_found, moved->rms_px));
    if (kRefitShare * moved->rms_px < alone.options.intrinsics->settled_px) break;
  }
  return run;
}

}  // namespace

IntrinsicsRun calibrateIntrinsics(const Session& session, std::size_t camera, const RunContext& context) {
  const Stopwatch stopwatch;
  const Session alone = cameraAlone(session, camera);
  const bool events = SessionRecording(alone).camera(0).type == StreamType::Events && !alone.board_blinks;
  IntrinsicsRun run = events ? fromEvents(alone, context) : fromSensorPixels(alone, context);
  checkBoardSize(run.detections.cameras.front(), alone.board, alone.options.front_end->extent);
  run.result.elapsed_s = stopwatch.elapsed_s();
  return run;
}

IntrinsicsResult jointIntrinsics(const IntrinsicsResult& first, std::size_t camera,
                                 const CameraIntrinsics& solved, const UncertaintyReport& report,
                                 const IntrinsicsOptions& options) {
  const Eigen::MatrixXd covariance = intrinsicsCovariance(report, camera);
  if (covariance.size() == 0) return first;
  IntrinsicsResult joint = first;
  joint.intrinsics = solved;
  joint.covariance.setZero();
  joint.covariance.topLeftCorner(covariance.rows(), covariance.cols()) = covariance;
  setSigmas(joint.intrinsics, joint.covariance, joint.image);
  constexpr bool kConverged = true;  // otherwise the whole calibration is doubtful already
  judge(kConverged, options, joint);
  return joint;
}

}  // namespace evical
