#include "core/pipeline/check/boardless_pass.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/data/calibration_stage.h"
#include "core/frontend/front_end_options.h"
#include "core/pipeline/pass/event_intake.h"
#include "core/pipeline/pass/recording_pass.h"
#include "core/pipeline/pass/session_recording.h"
#include "core/pipeline/pass/session_time_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

namespace evical {
namespace {

// Processing of one camera's events into windows.
struct MotionIntake {
  CameraKind kind = CameraKind::Events;
  std::unique_ptr<EventIntake> events;
  std::unique_ptr<CameraMotion> motion;

  void consume(std::vector<Event>& measured) {
    if (const std::optional<CameraBatch> batch = events->consume(measured))
      motion->add(batch->bursts, batch->complete_until_ns);
  }
  CameraRecord finish() {
    if (const std::optional<CameraBatch> batch = events->flush())
      motion->add(batch->bursts, batch->complete_until_ns);
    return motion->finish();
  }
};

MotionIntake intakeOf(std::size_t camera, const Session& session, const SessionRecording& recording) {
  MotionIntake intake;
  intake.kind = recording.kind(camera);
  if (intake.kind != CameraKind::Events) return intake;
  const Resolution resolution_px = recording.resolution_px(camera);
  const CameraIntrinsics& lens = *session.sensor(camera).intrinsics;
  intake.events = std::make_unique<EventIntake>(camera, session.cameras[camera], resolution_px,
                                                session.options.front_end->bursts, EventUse::Bursts);
  intake.motion = std::make_unique<CameraMotion>(lens, session.options, recording.start_ns());
  return intake;
}

}  // namespace

BoardlessPass readWithoutBoard(const Session& session, const RunContext& context) {
  context.progress.stageStarted(nameOf(CalibrationStage::Detect));
  BoardlessPass pass;
  {
    SessionRecording recording(session, context.stop);
    pass.start_ns = recording.start_ns();
    std::vector<MotionIntake> intakes;
    for (std::size_t camera = 0; camera < session.cameras.size(); ++camera)
      intakes.push_back(intakeOf(camera, session, recording));
    SessionTimeRange range(session, session.cameras.size() + session.imus.size(), pass.start_ns);
    SensorPacket packet;
    while (recording.read(packet) && !range.isOver(packet)) {
      context.throwIfStopped();
      context.progress.stageProgress(recording.fractionRead());
      if (packet.sensor >= intakes.size() || intakes[packet.sensor].kind != CameraKind::Events) continue;
      std::erase_if(packet.events, [&](const Event& event) { return !range.holds(event.time_ns); });
      intakes[packet.sensor].consume(packet.events);
    }
    context.throwIfStopped();
    range.checkBegin();
    for (MotionIntake& intake : intakes) {
      pass.kinds.push_back(intake.kind);
      pass.cameras.emplace_back();
      if (intake.kind != CameraKind::Events) continue;
      pass.cameras.back() = intake.finish();
      intake.events->report(pass.faults);
      if (intake.events->eventCount() == 0)
        throw badInput(
            session.recording.string(),
            fmt::format("stream {} has no events{}", session.cameras[pass.cameras.size() - 1].stream,
                        session.time_range_s ? " in " + howTo(HowTo::LimitTime) : ""),
            "Check the recording " + howTo(HowTo::Inspect));
    }
    const std::vector<RecordingFault> faults = recording.faults();
    pass.faults.insert(pass.faults.end(), faults.begin(), faults.end());
  }
  DetectionResult samples = readImus(session, pass.start_ns, context);
  pass.imus = std::move(samples.imus);
  pass.imu_stamp_steps_s = std::move(samples.imu_stamp_steps_s);
  return pass;
}

CameraMotion::CameraMotion(const CameraIntrinsics& lens, const CalibrationOptions& options,
                           std::int64_t start_ns)
    : lens_(lens),
      options_(*options.egomotion),
      start_ns_(start_ns),
      slopes_(lens.resolution_px, *options.edge_slopes, options.egomotion->window_s,
              [this](std::int64_t begin_ns, std::span<const EdgeSlope> slopes) {
                std::vector<WindowMotion>& windows = record_.windows;
                windows.push_back(estimateWindowMotion(slopes, lens_, {start_ns_, begin_ns}, options_));
                if (windows.back().use == WindowUse::Used)
                  record_.slopes.add(windows.size() - 1, begin_ns, slopes, options_);
              }) {}

CameraRecord CameraMotion::finish() {
  slopes_.finish();
  return std::move(record_);
}

}  // namespace evical
