#include "core/pipeline/detection/recording_pass.h"

#include "core/pipeline/detection/board_size_check.h"
#include "core/pipeline/detection/bounded_queue.h"
#include "core/pipeline/detection/camera_views.h"
#include "core/pipeline/detection/event_intake.h"
#include "core/pipeline/detection/session_recording.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/base/number.h"
#include "core/base/time.h"
#include "core/data/calibration_observer.h"
#include "core/data/imu_stamps.h"
#include "core/frames/frame_tracker.h"
#include "core/frontend/board_scene.h"
#include "core/frontend/detection_options.h"
#include "core/initialisation/initialisation_options.h"
#include "core/optimisation/optimisation_options.h"

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cstddef>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace evical {
namespace {

constexpr std::size_t kQueuedBatches = 16;
constexpr std::size_t kWindowThreads = 2;

// Collects the views of each camera in window threads. Events need one thread, next to that which reads and
// sorts them. Frames leave the reading thread little to do, so that frame cameras take turns among all.
class WindowWorkers {
 public:
  WindowWorkers(const Session& session, const std::vector<CameraLens>& lenses, const RunContext& context)
      : session_(session),
        lenses_(lenses),
        context_(context),
        thread_of_(session.cameras.size()),
        views_(session.cameras.size()) {}

  // Called for each camera before the start.
  void assign(std::size_t camera, CameraKind kind) {
    thread_of_[camera] = kind == CameraKind::Frames ? frame_cameras_++ % kWindowThreads : 0;
  }
  void start() {
    for (Worker& worker : workers_) worker.thread = std::jthread([this, &worker] { run(worker); });
  }
  // False after a failure, or if a run was stopped.
  bool push(CameraBatch batch) {
    Worker& worker = workers_[thread_of_[batch.camera]];
    return worker.queue.push(std::move(batch));
  }
  // True if batches wait for the camera's thread.
  bool isBehind(std::size_t camera) const { return !workers_[thread_of_[camera]].queue.empty(); }
  // After the last batch, or a failure.
  void close() {
    for (Worker& worker : workers_) worker.queue.close();
  }
  // Waits for the end, and throws the first failure again.
  void join() {
    for (Worker& worker : workers_) worker.thread.join();
    for (const Worker& worker : workers_)
      if (worker.failure) std::rethrow_exception(worker.failure);
  }

  // Time that the busiest thread worked.
  double busy_s() const { return std::ranges::max_element(workers_, {}, &Worker::busy_s)->busy_s; }
  // Resolutions of frames, if not known otherwise; called before finishing.
  void fillResolutions(std::vector<Resolution>& resolutions_px) const {
    for (std::size_t k = 0; k < views_.size(); ++k)
      if (views_[k] && !resolutions_px[k].known()) resolutions_px[k] = views_[k]->resolution_px();
  }

  std::vector<BoardObservations> finish(std::vector<RecordingFault>& faults) {
    std::vector<BoardObservations> observations(views_.size());
    const Stopwatch stopwatch;
    for (std::size_t k = 0; k < views_.size(); ++k) {
      if (views_[k]) observations[k] = views_[k]->finish(faults);
      observations[k].camera = session_.cameras[k].name;
    }
    workers_[0].busy_s += stopwatch.elapsed_s();
    return observations;
  }

 private:
  struct Worker {
    BoundedQueue<CameraBatch> queue{kQueuedBatches};
    std::exception_ptr failure;
    double busy_s = 0.0;
    std::jthread thread;  // last: it ends first
  };

  void run(Worker& worker) {
    try {
      while (std::optional<CameraBatch> batch = worker.queue.pop()) {
        if (context_.stop.stop_requested()) break;
        const Stopwatch stopwatch;
        handle(*batch);
        worker.busy_s += stopwatch.elapsed_s();
      }
    } catch (...) {
      worker.failure = std::current_exception();
    }
    worker.queue.close();
  }

  void handle(const CameraBatch& batch) {
    std::unique_ptr<CameraViews>& views = views_[batch.camera];
    if (batch.opened_px) {
      const std::lock_guard lock(observing_);
      views = cameraViews(batch, {session_, lenses_[batch.camera], context_});
    }
    const std::size_t before = views->soFar().windows.size();
    views->consume(batch);
    if (context_.observer == nullptr || views->soFar().windows.size() == before) return;
    const std::lock_guard lock(observing_);
    context_.observer->windowsDetected(batch.camera, views->soFar());
  }

  const Session& session_;
  const std::vector<CameraLens>& lenses_;
  const RunContext& context_;
  std::vector<std::size_t> thread_of_;               // by camera
  std::vector<std::unique_ptr<CameraViews>> views_;  // by camera, each used by its thread only
  std::size_t frame_cameras_ = 0;
  std::mutex observing_;  // one call at a time
  std::array<Worker, kWindowThreads> workers_;
};

// Reads packets and passes them to intakes and IMUs, within the session's time range.
class ReadingPass {
 public:
  // `start_ns`: start of the whole session, if not all of its sensors are read; origin of the time range.
  ReadingPass(const Session& session, const RunContext& context, DetectionResult& result,
              std::optional<std::int64_t> start_ns = {}, const LivePass* live = nullptr)
      : session_(session),
        live_(live),
        recording_(session, context.stop, live != nullptr ? live->growth : nullptr),
        result_(result),
        range_(session, session.cameras.size() + session.imus.size(),
               start_ns.value_or(recording_.start_ns())) {
    result.imus.resize(session.imus.size());
    result.start_ns = start_ns.value_or(recording_.start_ns());
    for (std::size_t camera = 0; camera < session.cameras.size(); ++camera) {
      const Resolution resolution_px = recording_.resolution_px(camera);
      result.resolutions_px.push_back(resolution_px);
      Intake& intake = intakes_.emplace_back();
      intake.kind = recording_.kind(camera);
      if (intake.kind == CameraKind::Events)
        intake.events.emplace(camera, session.cameras[camera], resolution_px,
                              burstsFor(session.boardOf(camera), session.options.front_end->bursts),
                              session.board_blinks ? EventUse::Raw : EventUse::Bursts);
      if (intake.kind == CameraKind::Frames) intake.rate.emplace(*session.options.frames);
    }
  }

  void run(WindowWorkers& windows, const RunContext& context) {
    SensorPacket packet;
    while (recording_.read(packet)) {
      context.throwIfStopped();
      context.progress.stageProgress(recording_.fractionRead());
      if (range_.isOver(packet)) break;
      const bool is_camera = packet.sensor < intakes_.size();
      if (!is_camera) addSamples(packet);
      if (live_ != nullptr && live_->samplesRead) live_->samplesRead(result_);
      if (is_camera && !addMeasured(packet, windows)) return;
    }
    context.throwIfStopped();
    range_.checkBegin();
    for (std::size_t camera = 0; camera < intakes_.size(); ++camera) {
      if (!intakes_[camera].events) continue;
      flush(camera, windows);
      if (std::optional<CameraBatch> batch = intakes_[camera].events->flush())
        windows.push(std::move(*batch));
    }
  }

  void finish() {
    std::vector<double> steps_s;
    for (std::size_t k = 0; k < session_.imus.size(); ++k)
      steps_s.push_back(finishImu(session_.imus[k], result_.imus[k]));
    if (std::ranges::any_of(steps_s, [](double step_s) { return step_s > 0.0; }))
      result_.imu_stamp_steps_s = std::move(steps_s);
    for (const Intake& intake : intakes_)
      if (intake.events) intake.events->report(result_.faults);
    const std::vector<RecordingFault> faults = recording_.faults();
    result_.faults.insert(result_.faults.end(), faults.begin(), faults.end());
  }

  // Number of events, frames or points.
  std::uint64_t count(std::size_t camera) const {
    const Intake& intake = intakes_[camera];
    return intake.events ? intake.events->eventCount() : intake.count;
  }
  double stampStep_s(std::size_t camera) const {
    const Intake& intake = intakes_[camera];
    return intake.events ? intake.events->stampStep_s() : 0.0;
  }
  CameraKind kind(std::size_t camera) const { return intakes_[camera].kind; }

 private:
  struct Intake {
    CameraKind kind = CameraKind::Events;
    std::optional<EventIntake> events;
    std::vector<Event> pending;
    std::optional<FrameRate> rate;
    std::uint64_t count = 0;  // of other types
    bool opened = false;
  };

  void addSamples(const SensorPacket& packet) {
    std::vector<ImuSample>& samples = result_.imus[packet.sensor - intakes_.size()].samples;
    for (const ImuSample& sample : packet.imu_samples) {
      if (range_.holds(sample.time_ns)) samples.push_back(sample);
    }
  }

  bool addMeasured(SensorPacket& packet, WindowWorkers& windows) {
    const auto unwanted = [&](const auto& item) { return !range_.holds(item.time_ns); };
    std::erase_if(packet.events, unwanted);
    std::erase_if(packet.points, unwanted);
    std::erase_if(packet.frames, unwanted);
    Intake& intake = intakes_[packet.sensor];
    if (intake.kind == CameraKind::Events) return addEvents(packet, windows);
    intake.count += packet.points.size() + packet.frames.size();
    if (intake.rate)
      std::erase_if(packet.frames, [&](const Frame& frame) {
        return !intake.rate->isDue(secondsSince(result_.start_ns, frame.time_ns));
      });
    if (packet.points.empty() && packet.frames.empty()) return true;
    if (windows.isBehind(packet.sensor)) std::ranges::for_each(packet.frames, decodeAhead);
    CameraBatch batch;
    if (!std::exchange(intake.opened, true)) batch.opened_px = result_.resolutions_px[packet.sensor];
    batch.camera = packet.sensor;
    batch.kind = intake.kind;
    batch.start_ns = result_.start_ns;
    batch.points = std::move(packet.points);
    batch.frames = std::move(packet.frames);
    return windows.push(std::move(batch));
  }

  bool addEvents(SensorPacket& packet, WindowWorkers& windows) {
    std::vector<Event>& pending = intakes_[packet.sensor].pending;
    pending.insert(pending.end(), packet.events.begin(), packet.events.end());
    if (pending.size() < kBatchEvents) return true;
    return flush(packet.sensor, windows);
  }

  bool flush(std::size_t camera, WindowWorkers& windows) {
    std::optional<CameraBatch> batch = intakes_[camera].events->consume(intakes_[camera].pending);
    intakes_[camera].pending.clear();
    if (!batch) return true;
    batch->start_ns = result_.start_ns;
    return windows.push(std::move(*batch));
  }

  // Returns the step of coarse stamps.
  double finishImu(const SessionImu& session, ImuData& imu) {
    imu.name = session.name;
    imu.noise = session.noise;
    if (imu.samples.empty()) return 0.0;
    const double step_s = putInOrder(session.joinedStream(), imu.samples.front().time_ns, imu.samples,
                                     result_.faults, *session_.options.stamps);
    imu.samples.shrink_to_fit();
    return step_s;
  }

  const Session& session_;
  const LivePass* live_;
  SessionRecording recording_;
  DetectionResult& result_;
  std::vector<Intake> intakes_;  // by camera
  SessionTimeRange range_;
};

void checkSamples(const Session& session, const DetectionResult& detections) {
  for (std::size_t k = 0; k < detections.imus.size(); ++k) {
    const std::size_t count = detections.imus[k].samples.size();
    if (count >= kFewestImuSamples) continue;
    const std::filesystem::path& own = session.imus[k].recording;
    throw badInput((own.empty() ? session.recording : own).string(),
                   fmt::format("IMU {} has {}{}", detections.imus[k].name,
                               count == 0 ? "no samples" : counted(count, "sample"),
                               session.time_range_s ? " in " + howTo(HowTo::LimitTime) : ""),
                   "Check the recording " + howTo(HowTo::Inspect));
  }
}

}  // namespace

DetectionResult readAndDetect(const Session& session, const RunContext& context) {
  return readAndDetect(session, givenLenses(session), context);
}

DetectionResult readAndDetect(const Session& session, std::vector<CameraLens> lenses,
                              const RunContext& context, const LivePass* live) {
  DetectionResult result;
  result.lenses = std::move(lenses);
  const Stopwatch stopwatch;
  ReadingPass reading(session, context, result, {}, live);
  WindowWorkers windows(session, result.lenses, context);
  for (std::size_t k = 0; k < session.cameras.size(); ++k) windows.assign(k, reading.kind(k));
  windows.start();
  try {
    reading.run(windows, context);
  } catch (...) {
    windows.close();
    throw;
  }
  result.read_s = stopwatch.elapsed_s();
  windows.close();
  windows.join();
  context.throwIfStopped();
  windows.fillResolutions(result.resolutions_px);
  result.cameras = windows.finish(result.faults);
  context.throwIfStopped();
  result.detect_s = windows.busy_s();
  reading.finish();
  for (std::size_t k = 0; k < session.cameras.size(); ++k) {
    result.cameras[k].kind = reading.kind(k);
    result.cameras[k].events = reading.count(k);
    result.cameras[k].stamp_step_s = reading.stampStep_s(k);
    if (result.cameras[k].events > 0) continue;
    throw badInput(
        session.recording.string(),
        fmt::format("stream {} has no {}{}", session.cameras[k].stream, measurementsOf(reading.kind(k)),
                    session.time_range_s ? " in " + howTo(HowTo::LimitTime) : ""),
        "Check the recording " + howTo(HowTo::Inspect));
  }
  checkSamples(session, result);
  return result;
}

DetectionResult readImus(const Session& session, std::int64_t start_ns, const RunContext& context) {
  DetectionResult result;
  if (session.imus.empty()) return result;
  Session imus_only = session;
  imus_only.cameras.clear();
  const Stopwatch stopwatch;
  ReadingPass reading(imus_only, context, result, start_ns);
  WindowWorkers none(imus_only, result.lenses, context);
  reading.run(none, context);
  context.throwIfStopped();
  reading.finish();
  checkSamples(session, result);
  result.read_s = stopwatch.elapsed_s();
  return result;
}

namespace {

// Fixes time offsets in the initialisation that are fixed in the batch.
void holdTimeOffsets(CalibrationInput& input) {
  for (std::size_t k = 0; k < input.cameras.size(); ++k)
    if (!input.isReferenceCamera(k))
      input.cameras[k].prior.time_offset = heldTimeOffset(input.cameras[k].prior);
  for (std::size_t k = 0; k < input.imus.size(); ++k)
    if (k != input.reference_imu) input.imus[k].prior.time_offset = heldTimeOffset(input.imus[k].prior);
}

}  // namespace

CalibrationInput makeInput(const Session& session, DetectionResult& detections) {
  CalibrationInput input;
  input.start_ns = detections.start_ns;
  input.board_name = session.board_name;
  input.board = session.board;
  input.further_boards.assign(session.further_boards.begin(), session.further_boards.end());
  for (std::size_t k = 0; k < session.cameras.size(); ++k) {
    const SessionCamera& camera = session.cameras[k];
    input.cameras.push_back({camera.name, detections.lenses.at(k), std::move(detections.cameras[k]),
                             camera.prior, camera.shutter});
    if (const std::size_t sensor = session.sensorOf(k); sensor != k)
      input.cameras.back().same_sensor_as = sensor;
    input.cameras.back().board = session.boardIndexOf(k);
  }
  input.imus = std::move(detections.imus);
  for (std::size_t k = 0; k < session.imus.size(); ++k) input.imus[k].prior = session.imus[k].prior;
  input.reference_imu = session.referenceImu();
  input.reference_camera = session.referenceCamera();
  input.gravity_norm_m_s2 = session.options.initialisation->gravity_m_s2;
  if (!session.options.optimisation->free_time_offsets) holdTimeOffsets(input);
  return input;
}

StatedSigns statedSigns(const Session& session) {
  StatedSigns stated;
  for (const SessionCamera& camera : session.cameras) stated.mirroring.push_back(camera.mirrored);
  for (const SessionImu& imu : session.imus) {
    Eigen::Matrix3d axes;
    for (Eigen::Index i = 0; i < 3; ++i)
      axes.col(i) = readAs(imu.accelerometer_axes, Eigen::Vector3d::Unit(i));
    const double unit = metresPerSecond2(imu.acceleration_unit.value_or(AccelerationUnit::Gravity));
    stated.inverted_forces.push_back(unit * axes.determinant() < 0.0);
  }
  return stated;
}

void restorePass(CalibrationInput input, DetectionResult& detections) {
  if (input.cameras.empty()) return;
  for (std::size_t k = 0; k < input.cameras.size(); ++k)
    detections.cameras[k] = std::move(input.cameras[k].observations);
  detections.imus = std::move(input.imus);
  for (ImuData& imu : detections.imus) imu.prior = {};
}

}  // namespace evical
