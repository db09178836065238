#include "core/pipeline/intrinsics_calibration.h"

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/base/time.h"
#include "core/data/calibration_stage.h"
#include "core/geometry/projection_difference.h"
#include "core/intrinsics/estimate_intrinsics.h"
#include "core/pipeline/board_size_check.h"
#include "core/pipeline/lens_pilot.h"
#include "core/pipeline/session_recording.h"

#include <fmt/format.h>

#include <utility>

namespace evical {
namespace {

// A refit moves centres by less than this part of what the lens changed by. A change c that grows with the
// third power of the distance from the image's middle, up to L, bends a circle of radius r so that its
// ellipse's centre moves by about c (r / L)^2; circles are a seventh of L at most.
constexpr double kRefitShare = 0.02;

Session cameraAlone(const Session& session, std::size_t camera) {
  Session alone = session;
  alone.cameras = {session.cameras[camera]};
  alone.cameras.front().intrinsics.reset();
  alone.imus.clear();
  alone.reference = alone.cameras.front().name;
  if (!alone.time_range_s) return alone;
  // It counts from the first event or sample of all sensors.
  const double later_s =
      secondsSince(SessionRecording(session).start_ns(), SessionRecording(alone).start_ns());
  for (double& time_s : *alone.time_range_s) time_s -= later_s;
  return alone;
}

// A board of another size than the session says may fail in any way: that is told first.
IntrinsicsResult estimate(const Session& alone, const RecordingPass& pass,
                          const std::optional<CameraIntrinsics>& start, const RunContext& context) {
  const BoardObservations& observations = pass.cameras.front();
  try {
    return estimateIntrinsics(
        {alone.board, pass.resolutions_px.front(), observations, pass.lenses.front().seen_with, start},
        alone.options.intrinsics, context);
  } catch (const CalibrationError&) {
    checkBoardSize(observations, alone.board, alone.options.front_end.extent);
    throw;
  }
}

// Frames and points are measured on the sensor, whatever the lens: once is enough.
IntrinsicsRun fromSensorPixels(const Session& alone, const RunContext& context) {
  context.progress.stageStarted(nameOf(CalibrationStage::Intrinsics));
  IntrinsicsRun run;
  run.pass = readAndDetect(alone, {CameraLens{}}, context.unobserved());
  checkBoardSeen(run.pass.cameras.front(), alone.board);
  run.result = estimate(alone, run.pass, {}, context);
  run.result.passes = 1;
  return run;
}

IntrinsicsRun fromEvents(const Session& alone, const RunContext& context) {
  context.progress.stageStarted(nameOf(CalibrationStage::FirstLook));
  CameraLens lens;
  lens.seen_with = lookThroughPlainLenses(alone, context);
  IntrinsicsRun run;
  std::optional<CameraIntrinsics> start;
  for (int pass = 1; pass <= alone.options.intrinsics.most_passes; ++pass) {
    context.progress.stageStarted(nameOf(CalibrationStage::Intrinsics));
    run.pass = readAndDetect(alone, {lens}, context.unobserved());
    checkBoardSeen(run.pass.cameras.front(), alone.board);
    run.result = estimate(alone, run.pass, start, context);
    run.result.passes = pass;
    const CameraIntrinsics found = run.result.intrinsics;
    const auto moved =
        lens.seen_with ? std::optional(projectionDifference(found, *lens.seen_with)) : std::nullopt;
    lens.seen_with = start = found;
    if (!moved) continue;
    run.result.moved_px = moved->rms_px;
    context.progress.log(LogLevel::Debug, fmt::format("pass {}: {} views, moved by {:.4f} px", pass,
                                                      run.result.views_found, moved->rms_px));
    if (kRefitShare * moved->rms_px < alone.options.intrinsics.settled_px) break;
  }
  return run;
}

}  // namespace

IntrinsicsRun calibrateIntrinsics(const Session& session, std::size_t camera, const RunContext& context) {
  const Stopwatch stopwatch;
  const Session alone = cameraAlone(session, camera);
  const bool events = SessionRecording(alone).camera(0).type == StreamType::Events;
  IntrinsicsRun run = events ? fromEvents(alone, context) : fromSensorPixels(alone, context);
  checkBoardSize(run.pass.cameras.front(), alone.board, alone.options.front_end.extent);
  run.result.elapsed_s = stopwatch.elapsed_s();
  return run;
}

}  // namespace evical
