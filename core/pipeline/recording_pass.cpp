#include "core/pipeline/recording_pass.h"

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/base/time.h"
#include "core/data/calibration_observer.h"
#include "core/frontend/board_tracker.h"
#include "core/pipeline/bounded_queue.h"
#include "core/pipeline/session_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

namespace evical {
namespace {

constexpr std::size_t kQueuedBatches = 16;
constexpr std::size_t kBatchEvents = 50'000;

// What the reading thread hands to the window thread: bursts of one camera.
struct BurstBatch {
  std::size_t camera = 0;
  std::vector<EdgeBurst> bursts;
  std::int64_t first_event_ns = 0, complete_until_ns = 0;
  std::uint64_t events = 0;
  std::optional<Resolution> opened_px;  // with the first batch
  std::int64_t start_ns = 0;
};

// One camera's events on their way: checked, sorted, turned into bursts.
class CameraIntake {
 public:
  CameraIntake(std::size_t camera, const SessionCamera& session, Resolution resolution_px,
               const BurstOptions& bursts)
      : camera_(camera), session_(session), burst_options_(bursts), resolution_px_(resolution_px) {}

  std::optional<BurstBatch> take(std::vector<Event>& events) {
    putInOrder(events);
    if (events.empty()) return std::nullopt;
    BurstBatch batch;
    if (!extractor_) {
      extractor_.emplace(resolution_px_, burst_options_);
      batch.opened_px = resolution_px_;
    }
    batch.camera = camera_;
    batch.first_event_ns = events.front().time_ns;
    extractor_->add(events, batch.bursts);
    batch.complete_until_ns = extractor_->completeUntil_ns();
    batch.events = events.size();
    last_ns_ = events.back().time_ns;
    return batch;
  }

  std::optional<BurstBatch> finish() {
    if (!extractor_) return std::nullopt;
    BurstBatch batch;
    batch.camera = camera_;
    extractor_->finish(batch.bursts);
    batch.first_event_ns = batch.complete_until_ns = last_ns_;
    return batch;
  }

  std::uint64_t eventCount() const { return extractor_ ? extractor_->eventCount() : 0; }
  Resolution resolution_px() const { return resolution_px_; }

  void report(std::vector<RecordingFault>& faults) const {
    if (unsorted_ > 0) {
      faults.push_back({session_.stream, FaultKind::BackwardTime, 0.0,
                        fmt::format("{}: {} events out of order, sorted", session_.stream, unsorted_)});
    }
    if (late_ > 0) {
      faults.push_back({session_.stream, FaultKind::BackwardTime, 0.0,
                        fmt::format("{}: time runs backwards: {} events left out", session_.stream, late_)});
    }
    if (outside_ > 0) {
      faults.push_back({session_.stream, FaultKind::OutsideResolution, 0.0,
                        fmt::format("{}: {} events outside {} x {} px left out", session_.stream, outside_,
                                    resolution_px_.width_px, resolution_px_.height_px)});
    }
  }

 private:
  void putInOrder(std::vector<Event>& events) {
    const auto earlier = [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; };
    if (!std::is_sorted(events.begin(), events.end(), earlier)) {
      for (std::size_t k = 1; k < events.size(); ++k) unsorted_ += events[k].time_ns < events[k - 1].time_ns;
      std::stable_sort(events.begin(), events.end(), earlier);
    }
    seen_ += events.size();
    outside_ += std::erase_if(events, [&](const Event& event) {
      return event.x_px >= resolution_px_.width_px || event.y_px >= resolution_px_.height_px;
    });
    late_ += std::erase_if(events, [&](const Event& event) { return event.time_ns < last_ns_; });
    // A few stray coordinates are a broken packet; many are a wrong resolution.
    constexpr std::uint64_t kEnough = 1000;
    if (seen_ >= kEnough && 20 * outside_ > seen_) {
      throw badInput(session_.name,
                     fmt::format("resolution_px {} x {} is too small: {} of {} events lie outside",
                                 resolution_px_.width_px, resolution_px_.height_px, outside_, seen_),
                     "Give the sensor's own resolution, and intrinsics that belong to it");
    }
  }

  std::size_t camera_;
  const SessionCamera& session_;
  BurstOptions burst_options_;
  Resolution resolution_px_;
  std::optional<BurstExtractor> extractor_;
  std::int64_t last_ns_ = std::numeric_limits<std::int64_t>::min();
  std::uint64_t seen_ = 0, outside_ = 0, unsorted_ = 0, late_ = 0;
};

// The window thread: one tracker a camera.
class WindowWorker {
 public:
  WindowWorker(const Session& session, const std::vector<CameraLens>& lenses, const RunContext& context)
      : session_(session), lenses_(lenses), context_(context), trackers_(session.cameras.size()) {}

  void run(BoundedQueue<BurstBatch>& queue) {
    try {
      while (std::optional<BurstBatch> batch = queue.pop()) {
        if (context_.stop.stop_requested()) break;
        const Stopwatch stopwatch;
        handle(*batch);
        busy_s_ += stopwatch.elapsed_s();
      }
    } catch (...) {
      failure_ = std::current_exception();
    }
    queue.close();
  }

  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }
  double busy_s() const { return busy_s_; }

  std::vector<BoardObservations> finish() {
    std::vector<BoardObservations> observations(trackers_.size());
    const Stopwatch stopwatch;
    for (std::size_t k = 0; k < trackers_.size(); ++k) {
      if (trackers_[k]) observations[k] = trackers_[k]->finish();
      observations[k].camera = session_.cameras[k].name;
    }
    busy_s_ += stopwatch.elapsed_s();
    return observations;
  }

 private:
  void handle(const BurstBatch& batch) {
    std::unique_ptr<BoardTracker>& tracker = trackers_[batch.camera];
    if (batch.opened_px) {
      tracker =
          std::make_unique<BoardTracker>(session_.board, *batch.opened_px, lenses_[batch.camera].seen_with,
                                         session_.options.front_end, batch.start_ns);
      tracker->stopWith(context_.stop);
      if (context_.observer != nullptr)
        tracker->observeWith(context_.observer->windowObserver(batch.camera, *tracker));
    }
    const std::size_t before = tracker->observations().windows.size();
    tracker->addBursts(batch.bursts, batch.first_event_ns, batch.complete_until_ns);
    if (context_.observer != nullptr && tracker->observations().windows.size() > before)
      context_.observer->windowsDetected(batch.camera, tracker->observations());
  }

  const Session& session_;
  const std::vector<CameraLens>& lenses_;
  const RunContext& context_;
  std::vector<std::unique_ptr<BoardTracker>> trackers_;
  std::exception_ptr failure_;
  double busy_s_ = 0.0;
};

// Reading: packets to intakes and IMUs, within the session's time range.
class ReadingPass {
 public:
  ReadingPass(const Session& session, const RunContext& context, RecordingPass& result)
      : session_(session),
        recording_(session, context.stop),
        result_(result),
        pending_(session.cameras.size()) {
    result.imus.resize(session.imus.size());
    result.start_ns = recording_.start_ns();
    for (std::size_t camera = 0; camera < session.cameras.size(); ++camera) {
      intakes_.push_back(std::make_unique<CameraIntake>(camera, session.cameras[camera],
                                                        recording_.resolution_px(camera),
                                                        session.options.front_end.bursts));
    }
  }

  void run(BoundedQueue<BurstBatch>& queue, const RunContext& context) {
    SensorPacket packet;
    while (recording_.read(packet)) {
      context.throwIfStopped();
      context.progress.stageProgress(recording_.fractionRead());
      const bool is_camera = packet.sensor < intakes_.size();
      if (!is_camera) addSamples(packet);
      if (is_camera && !addEvents(packet, queue)) return;
    }
    for (std::size_t camera = 0; camera < intakes_.size(); ++camera) {
      flush(camera, queue);
      if (std::optional<BurstBatch> batch = intakes_[camera]->finish()) queue.push(std::move(*batch));
    }
  }

  void finish() {
    for (std::size_t k = 0; k < session_.imus.size(); ++k) finishImu(session_.imus[k], result_.imus[k]);
    for (const auto& intake : intakes_) {
      intake->report(result_.faults);
      result_.resolutions_px.push_back(intake->resolution_px());
    }
    const std::vector<RecordingFault> faults = recording_.faults();
    result_.faults.insert(result_.faults.end(), faults.begin(), faults.end());
  }

  std::uint64_t eventCount(std::size_t camera) const { return intakes_[camera]->eventCount(); }

 private:
  bool wanted(std::int64_t time_ns) const {
    if (!session_.time_range_s) return true;
    const double time_s = secondsSince(result_.start_ns, time_ns);
    return time_s >= (*session_.time_range_s)[0] && time_s <= (*session_.time_range_s)[1];
  }

  void addSamples(const SensorPacket& packet) {
    std::vector<ImuSample>& samples = result_.imus[packet.sensor - intakes_.size()].samples;
    for (const ImuSample& sample : packet.imu_samples) {
      if (wanted(sample.time_ns)) samples.push_back(sample);
    }
  }

  bool addEvents(SensorPacket& packet, BoundedQueue<BurstBatch>& queue) {
    if (session_.time_range_s)
      std::erase_if(packet.events, [&](const Event& e) { return !wanted(e.time_ns); });
    std::vector<Event>& pending = pending_[packet.sensor];
    pending.insert(pending.end(), packet.events.begin(), packet.events.end());
    if (pending.size() < kBatchEvents) return true;
    return flush(packet.sensor, queue);
  }

  bool flush(std::size_t camera, BoundedQueue<BurstBatch>& queue) {
    std::optional<BurstBatch> batch = intakes_[camera]->take(pending_[camera]);
    pending_[camera].clear();
    if (!batch) return true;
    batch->start_ns = result_.start_ns;
    return queue.push(std::move(*batch));
  }

  void finishImu(const SessionImu& session, ImuData& imu) {
    imu.name = session.name;
    imu.noise = session.noise;
    const auto earlier = [](const ImuSample& a, const ImuSample& b) { return a.time_ns < b.time_ns; };
    if (!std::is_sorted(imu.samples.begin(), imu.samples.end(), earlier)) {
      result_.faults.push_back(
          {session.stream, FaultKind::BackwardTime, 0.0, session.stream + ": samples out of order, sorted"});
      std::stable_sort(imu.samples.begin(), imu.samples.end(), earlier);
    }
    const auto same = [](const ImuSample& a, const ImuSample& b) { return a.time_ns == b.time_ns; };
    imu.samples.erase(std::unique(imu.samples.begin(), imu.samples.end(), same), imu.samples.end());
  }

  const Session& session_;
  SessionRecording recording_;
  RecordingPass& result_;
  std::vector<std::unique_ptr<CameraIntake>> intakes_;
  std::vector<std::vector<Event>> pending_;  // by camera
};

}  // namespace

RecordingPass readAndDetect(const Session& session, const RunContext& context) {
  return readAndDetect(session, givenLenses(session), context);
}

RecordingPass readAndDetect(const Session& session, std::vector<CameraLens> lenses,
                            const RunContext& context) {
  RecordingPass result;
  result.lenses = std::move(lenses);
  const Stopwatch stopwatch;
  ReadingPass reading(session, context, result);
  WindowWorker worker(session, result.lenses, context);
  BoundedQueue<BurstBatch> queue(kQueuedBatches);
  {
    std::jthread windows([&] { worker.run(queue); });
    try {
      reading.run(queue, context);
    } catch (...) {
      queue.close();
      throw;
    }
    result.read_s = stopwatch.elapsed_s();
    queue.close();
  }
  worker.rethrow();
  context.throwIfStopped();
  result.cameras = worker.finish();
  context.throwIfStopped();
  result.detect_s = worker.busy_s();
  reading.finish();
  for (std::size_t k = 0; k < session.cameras.size(); ++k) {
    result.cameras[k].events = reading.eventCount(k);
    if (result.cameras[k].events > 0) continue;
    throw badInput(session.recording.string(),
                   fmt::format("stream {} holds no events{}", session.cameras[k].stream,
                               session.time_range_s ? " in time_range_s" : ""),
                   "Check the recording with 'evical inspect'");
  }
  for (const ImuData& imu : result.imus) {
    if (!imu.samples.empty()) continue;
    throw badInput(
        session.recording.string(),
        fmt::format("IMU {} has no samples{}", imu.name, session.time_range_s ? " in time_range_s" : ""),
        "Check the recording with 'evical inspect'");
  }
  return result;
}

}  // namespace evical
