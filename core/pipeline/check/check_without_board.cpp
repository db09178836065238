#include "core/pipeline/check/check_without_board.h"

#include "core/pipeline/check/check_verdict.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/base/nearest_name.h"
#include "core/data/calibration_observer.h"
#include "core/data/quantity.h"
#include "core/data/unfit_samples.h"
#include "core/egomotion/rotation_alignment.h"
#include "core/frontend/detection_options.h"
#include "core/geometry/so3.h"
#include "core/numerics/dense.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/compare/compared_quantities.h"
#include "core/pipeline/detection/event_intake.h"
#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/detection/session_recording.h"
#include "core/pipeline/session/calibration_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
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

namespace {

// Advice for windows that were not used.
const char* adviceFor(WindowUse use) {
  switch (use) {
    case WindowUse::FewEdges:
      return "Move more, in a scene with edges in all parts of the image";
    case WindowUse::HardlyMoving:
      return "Rotate the rig more: the image hardly moved";
    case WindowUse::NotExplained:
      return "Record a static scene without flickering lamps";
    case WindowUse::Uncertain:
      return "Record a scene with edges in all directions";
    case WindowUse::NoGyroscope:
      return "Check the IMU's samples: they do not cover the camera's events";
    case WindowUse::OutOfLine:
      return "Check that the lens and the IMU's units belong to this rig";
    case WindowUse::Used:
      break;
  }
  return "Record for longer: doubling the time makes sigmas 1.4 times smaller";
}

const char* keyOf(WindowUse use) {
  static constexpr std::array<const char*, kWindowUses> kKeys = {
      "used", "few_edges", "hardly_moving", "not_explained", "uncertain", "no_gyroscope", "out_of_line"};
  return kKeys.at(static_cast<std::size_t>(use));
}

CheckedWindows countedWindows(const std::string& sensor, const std::vector<WindowMotion>& windows) {
  CheckedWindows counted;
  counted.sensor = sensor;
  counted.all = windows.size();
  std::array<std::size_t, kWindowUses> uses = {};
  for (const WindowMotion& window : windows) {
    ++uses[static_cast<std::size_t>(window.use)];
    counted.turning_alone += window.use == WindowUse::Used && window.rotation_alone;
  }
  counted.used = uses[static_cast<std::size_t>(WindowUse::Used)];
  for (std::size_t k = 1; k < kWindowUses; ++k)
    if (uses[k] > 0)
      counted.left_out.push_back(
          {keyOf(static_cast<WindowUse>(k)), windowUseWords(static_cast<WindowUse>(k)), uses[k]});
  return counted;
}

WindowUse commonest(const std::vector<WindowMotion>& windows) {
  std::array<std::size_t, kWindowUses> uses = {};
  for (const WindowMotion& window : windows)
    if (window.use != WindowUse::Used) ++uses[static_cast<std::size_t>(window.use)];
  const auto most = std::max_element(uses.begin(), uses.end());
  return *most == 0 ? WindowUse::Used : static_cast<WindowUse>(most - uses.begin());
}

const char* nameOfAxis(const Eigen::Vector3d& direction) {
  constexpr std::array<const char*, 3> kNames = {"x", "y", "z"};
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return kNames.at(static_cast<std::size_t>(axis));
}

class BoardlessCheck {
 public:
  BoardlessCheck(const CheckInput& input, BoardlessPass pass, const RunContext& context)
      : input_(input), pass_(std::move(pass)), context_(context) {
    CalibrationCheck& check = out_.check;
    check.notes = input.notes;
    check.false_alarms = input.session.options.check->false_alarms;
    check.before = input.before_name;
    check.inputs = {input.session.recording.filename().string()};
    check.without_board = true;
    check.notes.push_back("without a board, only rotations and time offsets of event cameras are checked");
    out_.detections.start_ns = pass_.start_ns;
    out_.detections.faults = pass_.faults;
    out_.detections.imus = pass_.imus;
  }

  CheckRun run() {
    if (input_.before.imus.empty() || pass_.imus.empty()) {
      setCannotTell("a check without a board compares cameras with an IMU, but there is no IMU", out_.check);
      addAdvice("Record with the board in view", out_.check);
      return std::move(out_);
    }
    now_ = input_.before;
    result_ = std::make_shared<CalibrationResult>(*input_.before.result);
    result_->uncertainty = {};
    result_->uncertainty.cameras.resize(input_.before.cameras.size());
    result_->uncertainty.imus.resize(input_.before.imus.size());
    result_->uncertainty.further_boards.resize(input_.before.result->state.further_boards.size());
    for (std::size_t k = 0; k < input_.session.cameras.size(); ++k) alignCamera(k);
    judge();
    return std::move(out_);
  }

 private:
  template <class Sensors>
  static std::size_t placeOf(const std::string& name, const Sensors& sensors) {
    const auto found =
        std::find_if(sensors.begin(), sensors.end(), [&](const auto& sensor) { return sensor.name == name; });
    return static_cast<std::size_t>(found - sensors.begin());
  }

  void alignCamera(std::size_t k) {
    const std::string& name = input_.session.cameras[k].name;
    if (pass_.kinds[k] != CameraKind::Events) {
      out_.check.notes.push_back(fmt::format("{} is not checked: it is not an event camera", name));
      return;
    }
    const std::size_t imu = placeOf(input_.session.reference, input_.session.imus),
                      camera_before = placeOf(name, input_.before.cameras),
                      imu_before = placeOf(input_.session.reference, input_.before.imus);
    const CameraState& before = input_.before.result->state.cameras.at(camera_before);
    const std::vector<ImuSample> samples = withoutRateSpikes(pass_.imus.at(imu).samples);
    const LensRays lens(*input_.session.sensor(k).intrinsics);
    const RotationAlignment alignment = alignRotation(
        pass_.cameras[k], lens, {samples, pass_.start_ns, input_.before.result->state.imus.at(imu_before)},
        {before.reference_from_camera.rotation, before.time_offset_s}, *input_.session.options.egomotion,
        input_.session.options.optimisation->threads, context_);
    const CheckOptions& limits = *input_.session.options.check;
    const std::vector<WindowMotion>& windows = pass_.cameras[k].windows;
    out_.check.windows.push_back(countedWindows(name, windows));
    if (!alignment.found())
      return fail(name, alignment.failure,
                  alignment.advice.empty() ? std::vector<std::string>{adviceFor(commonest(windows))}
                                           : alignment.advice);
    if (alignment.misfit_rms_rad_s > limits.without_board_misfit * alignment.rate_rms_rad_s)
      return fail(
          name,
          fmt::format("the camera's rotation does not match the gyroscope's: residual {:.2g} of {:.2g} rad/s",
                      alignment.misfit_rms_rad_s, alignment.rate_rms_rad_s),
          {adviceFor(WindowUse::NotExplained), "Check that camera and IMU belong to the same rig"});
    if (std::abs(alignment.scale - 1.0) > limits.without_board_scale)
      return fail(name,
                  fmt::format("the image rotates {:.3g} times as fast as the gyroscope", alignment.scale),
                  {"Check that the lens belongs to this camera, and calibrate again with the board"});
    weakest_ = nameOfAxis(alignment.weakest_in_camera);
    take(camera_before, alignment);
  }

  void fail(const std::string& camera, const std::string& reason, const std::vector<std::string>& advice) {
    failures_.push_back(fmt::format("{}: {}", camera, reason));
    for (const std::string& one : advice) addAdvice(one, out_.check);
  }

  // Copies the alignment into the new result, as its only estimated numbers.
  void take(std::size_t camera, const RotationAlignment& alignment) {
    CameraState& state = result_->state.cameras[camera];
    state.reference_from_camera.rotation = alignment.imu_from_camera;
    state.time_offset_s = alignment.time_offset_s;
    Eigen::Matrix4d covariance = alignment.covariance;
    if (!pass_.imu_stamp_steps_s.empty())
      covariance(3, 3) += 0.25 * std::pow(pass_.imu_stamp_steps_s[input_.session.referenceImu()], 2);
    const Eigen::Vector4d sigmas = covariance.diagonal().cwiseSqrt();
    CameraUncertainty& uncertainty = result_->uncertainty.cameras[camera];
    uncertainty.rotation_std_rad = sigmas.head<3>();
    uncertainty.time_offset_std_s = sigmas[3];
    UncertaintyReport& report = result_->uncertainty;
    for (std::size_t axis = 0; axis < 3; ++axis)
      report.columns.push_back({QuantityOwner::Camera, camera, QuantityId::Rotation, axis});
    report.columns.push_back({QuantityOwner::Camera, camera, QuantityId::TimeOffset});
    const Eigen::Index size = report.standard_deviations.size();
    report.standard_deviations.conservativeResize(size + 4);
    report.standard_deviations.tail<4>() = sigmas;
    Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(size + 4, size + 4);
    if (size > 0) correlation.topLeftCorner(size, size) = report.correlation;
    correlation.bottomRightCorner<4, 4>() =
        sigmas.cwiseInverse().asDiagonal() * covariance * sigmas.cwiseInverse().asDiagonal();
    report.correlation = correlation;
  }

  void judge() {
    if (!result_->uncertainty.columns.empty()) {
      now_.result = result_;
      now_.options.clear();
      // These sigmas do not include pixel delays that depend on light.
      OptionRow& delay = now_.options.emplace_back();
      delay.name = "optimisation.verdict.pixel_delay_ms";
      delay.value = "0";
      CheckOptions options = *input_.session.options.check;
      options.stability_rotation_deg =
          std::max(options.stability_rotation_deg, options.without_board_min_rotation_deg);
      options.stability_time_offset_ms =
          std::max(options.stability_time_offset_ms, options.without_board_min_time_offset_ms);
      options.matters_rotation_deg = options.without_board_rotation_deg;
      options.matters_time_offset_ms = options.without_board_time_offset_ms;
      testQuantities(compareQuantities({input_.before, now_, false}, options), options, out_.check);
      for (Finding& finding : out_.check.findings) addJoint(finding);
      judgeFindings(out_.check);
      if (out_.check.verdict == Verdict::CannotTell) advise();
    }
    if (input_.duplicate) judgeDuplicate(out_.check);
    if (failures_.empty() || out_.check.verdict == Verdict::Changed) return;
    setCannotTell(joined(failures_), out_.check);
  }

  void advise() {
    addAdvice(
        fmt::format("Rotate about all axes in turn, and most about axes other than the camera's {} axis",
                    weakest_),
        out_.check);
    addAdvice(adviceFor(WindowUse::Used), out_.check);
  }

  // Combines both values of each number as independent estimates.
  static void addJoint(Finding& finding) {
    for (ComparedNumber& number : finding.numbers) {
      const double before = number.before.sigma * number.before.sigma,
                   now = number.now.sigma * number.now.sigma;
      if (!(before > 0.0) || !(now > 0.0))
        number.joint = before > 0.0 ? number.before : number.now;
      else
        number.joint = {(number.before.value * now + number.now.value * before) / (before + now),
                        std::sqrt(before * now / (before + now))};
    }
  }

  const CheckInput& input_;
  BoardlessPass pass_;
  const RunContext& context_;
  CheckRun out_;
  NamedResult now_;
  std::shared_ptr<CalibrationResult> result_;
  std::vector<std::string> failures_;
  const char* weakest_ = "z";
};

}  // namespace

CheckRun checkWithoutBoard(const CheckInput& input, const RunContext& context) {
  return checkWithoutBoard(input, readWithoutBoard(input.session, context), context);
}

CheckRun checkWithoutBoard(const CheckInput& input, BoardlessPass pass, const RunContext& context) {
  context.progress.stageStarted(nameOf(CalibrationStage::Optimise));
  return BoardlessCheck(input, std::move(pass), context).run();
}

}  // namespace evical
