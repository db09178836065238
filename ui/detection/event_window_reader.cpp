// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/event_window_reader.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/pipeline/detection/event_intake.h"
#include "core/pipeline/detection/session_recording.h"
#include "core/recording/separate_reader.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

namespace evical::ui {
namespace {

constexpr double kBin_s = 0.01;
constexpr std::size_t kMaxBins = 10'000'000;  // a day; no curve beyond a larger clock jump
constexpr auto kTellEvery = std::chrono::milliseconds(100);

// Sums and counts by bin of time.
class Bins {
 public:
  void add(double time_s, double value) {
    const double bin = std::floor(time_s / kBin_s);
    if (!(bin >= 0.0) || bin >= static_cast<double>(kMaxBins)) return;
    const auto k = static_cast<std::size_t>(bin);
    if (k >= counts_.size()) {
      counts_.resize(k + 1, 0);
      sums_.resize(k + 1, 0.0f);
    }
    ++counts_[k];
    sums_[k] += static_cast<float>(value);
  }
  RateCurve perSecond() const {
    RateCurve curve{0.0, kBin_s, {}};
    for (const std::uint32_t count : counts_) curve.values.push_back(static_cast<float>(count / kBin_s));
    return curve;
  }
  RateCurve means() const {
    RateCurve curve{0.0, kBin_s, {}};
    for (std::size_t k = 0; k < counts_.size(); ++k)
      curve.values.push_back(counts_[k] > 0 ? sums_[k] / static_cast<float>(counts_[k])
                                            : std::numeric_limits<float>::quiet_NaN());
    return curve;
  }

 private:
  std::vector<std::uint32_t> counts_;
  std::vector<float> sums_;
};

CameraKind kindOf(const SessionRecording& recording, const Session& session, std::size_t camera) {
  switch (recording.camera(camera).type) {
    case StreamType::Events:
      return CameraKind::Events;
    case StreamType::Frames:
      return CameraKind::Frames;
    default:
      throw badInput(session.cameras[camera].name,
                     "has a stream of points measured by another program, without pictures",
                     "Choose a camera with events or frames; the points are in detections.csv");
  }
}

// The resolution is known for event cameras, but not always for frame cameras.
std::optional<Resolution> knownSize(const SessionRecording& recording, std::size_t camera) {
  try {
    return recording.resolution_px(camera);
  } catch (const CalibrationError&) {
    return std::nullopt;
  }
}

std::optional<std::size_t> companionOf(const SessionRecording& recording, const Session& session,
                                       std::size_t camera, CameraKind kind) {
  const StreamType wanted = kind == CameraKind::Events ? StreamType::Frames : StreamType::Events;
  std::optional<std::size_t> first;
  for (std::size_t k = 0; k < session.cameras.size(); ++k) {
    if (recording.camera(k).type != wanted || !knownSize(recording, k)) continue;
    if (session.sensorOf(k) == session.sensorOf(camera)) return k;
    if (!first) first = k;
  }
  return first;
}

}  // namespace

// Fills the cache with the events that a calibration uses.
class EventWindowReader::CacheFilling {
 public:
  CacheFilling(EventCache& cache, std::size_t camera, const SessionCamera& session, Resolution resolution_px,
               std::int64_t start_ns)
      : cache_(cache), start_ns_(start_ns), intake_(camera, session, resolution_px, {}, EventUse::Raw) {}

  void take(const std::vector<Event>& events) {
    pending_.insert(pending_.end(), events.begin(), events.end());
    if (pending_.size() >= kBatchEvents) flush();
  }
  void finish() {
    flush();
    cache_.finish();
  }
  std::int64_t last_ns() const { return last_ns_; }
  RateCurve rate() const { return rate_.perSecond(); }

 private:
  void flush() {
    const std::optional<CameraBatch> batch = intake_.consume(pending_);
    pending_.clear();
    if (!batch) return;
    cache_.append(batch->events);
    last_ns_ = batch->complete_until_ns;
    for (const Event& event : batch->events) rate_.add(secondsSince(start_ns_, event.time_ns), 0.0);
  }

  EventCache& cache_;
  std::int64_t start_ns_;
  EventIntake intake_;
  std::vector<Event> pending_;
  std::int64_t last_ns_ = std::numeric_limits<std::int64_t>::min();
  Bins rate_;
};

// State of the reading thread.
class EventWindowReader::Pass {
 public:
  Pass(const Session& session, std::size_t camera, const std::filesystem::path& folder)
      : recording_(session),
        kind_(kindOf(recording_, session, camera)),
        companion_(companionOf(recording_, session, camera, kind_)),
        resolution_px_(recording_.resolution_px(camera)),
        start_ns_(recording_.start_ns()) {
    const bool events = kind_ == CameraKind::Events;
    if (events || companion_) {
      events_camera_ = events ? camera : *companion_;
      caches_.events_px = *knownSize(recording_, *events_camera_);
      auto cache = std::make_shared<EventCache>(folder);
      events_.emplace(*cache, *events_camera_, session.cameras[*events_camera_], caches_.events_px,
                      start_ns_);
      caches_.events = std::move(cache);
    }
    if (!events || companion_) {
      frames_camera_ = events ? *companion_ : camera;
      caches_.frames = frames_ = std::make_shared<FrameCache>(folder);
    }
    if (!session.imus.empty()) imu_ = recording_.imuSensor(session.referenceImu());
  }

  const RecordingCaches& caches() const { return caches_; }

  bool step() {
    if (!recording_.read(packet_)) {
      if (events_) events_->finish();
      return false;
    }
    started_ = true;
    if (packet_.sensor == events_camera_) events_->take(packet_.events);
    if (packet_.sensor == frames_camera_) {
      for (const Frame& frame : packet_.frames) frames_->append(frame);
    }
    if (packet_.sensor == imu_) {
      for (const ImuSample& sample : packet_.imu_samples)
        rotation_.add(secondsSince(start_ns_, sample.time_ns), sample.angular_rate_rad_s.norm());
    }
    return true;
  }

  void describe(RecordingOverview& overview) const {
    overview.started = started_;
    overview.start_ns = start_ns_;
    overview.kind = kind_;
    overview.companion = companion_;
    overview.resolution_px = resolution_px_;
    const std::int64_t last_ns =
        kind_ == CameraKind::Events ? events_->last_ns() : frames_->lastTime_ns().value_or(start_ns_);
    overview.read_until_s = last_ns >= start_ns_ ? secondsSince(start_ns_, last_ns) : 0.0;
    if (events_) overview.event_rate = events_->rate();
    overview.rotation_rate = rotation_.means();
    overview.fraction_read = recording_.fractionRead();
  }

 private:
  SessionRecording recording_;
  CameraKind kind_;
  std::optional<std::size_t> companion_, events_camera_, frames_camera_, imu_;
  Resolution resolution_px_;
  std::int64_t start_ns_;
  RecordingCaches caches_;
  std::optional<CacheFilling> events_;
  std::shared_ptr<FrameCache> frames_;
  SensorPacket packet_;
  bool started_ = false;
  Bins rotation_;
};

EventWindowReader::EventWindowReader(const Session& session, std::size_t camera,
                                     const std::filesystem::path& folder, std::function<void()> changed)
    : session_(session), camera_(camera), folder_(folder), published_(std::move(changed)) {}

RecordingOverview EventWindowReader::overview() const {
  const std::shared_ptr<const State> state = published_.take();
  return state ? state->overview : RecordingOverview{};
}

RecordingCaches EventWindowReader::caches() const {
  const std::shared_ptr<const State> state = published_.take();
  return state && state->overview.started ? state->caches : RecordingCaches{};
}

void EventWindowReader::publish() {
  published_.put(std::make_shared<State>(state_));
}

void EventWindowReader::readAll(const std::stop_token& stop) {
  Pass pass(session_, camera_, folder_);
  state_.caches = pass.caches();
  auto told = std::chrono::steady_clock::now();
  while (pass.step()) {
    if (stop.stop_requested()) return;
    if (std::chrono::steady_clock::now() - told < kTellEvery) continue;
    pass.describe(state_.overview);
    publish();
    told = std::chrono::steady_clock::now();
  }
  if (stop.stop_requested()) return;
  pass.describe(state_.overview);
  state_.overview.fraction_read = 1.0;
  state_.overview.finished = true;
  publish();
}

void EventWindowReader::read(const std::stop_token& stop) {
  const StopWaiting until_stop(stop);
  try {
    readAll(stop);
    return;
  } catch (const Cancelled&) {
    return;
  } catch (const std::exception& problem) {
    state_.overview.error = problem.what();
  }
  publish();
}

}  // namespace evical::ui
