// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/event_window_reader.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/pipeline/session_recording.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

namespace evical::ui {
namespace {

constexpr double kBin_s = 0.01;
constexpr std::size_t kMostBins = 10'000'000;  // a day; a clock that jumps further has no curve there
constexpr std::size_t kBatchEvents = 50'000;   // put in order together, as the calibration does
constexpr auto kTellEvery = std::chrono::milliseconds(100);

// Sums and counts by bin of time.
class Bins {
 public:
  void add(double time_s, double value) {
    const double bin = std::floor(time_s / kBin_s);
    if (!(bin >= 0.0) || bin >= static_cast<double>(kMostBins)) return;
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

std::string wordsOf(const CalibrationError& error) {
  return error.place() + ": " + error.problem() + (error.advice().empty() ? "" : ". " + error.advice());
}

}  // namespace

// The reading thread's own state.
class EventWindowReader::Pass {
 public:
  Pass(const Session& session, std::size_t camera, EventCache& cache)
      : cache_(cache),
        recording_(session),
        camera_(camera),
        resolution_px_(recording_.resolution_px(camera)),
        start_ns_(recording_.start_ns()) {
    if (recording_.camera(camera).type != StreamType::Events)
      throw badInput(session.cameras[camera].name,
                     "its stream holds no events, and only those are shown here",
                     "Choose an event camera; what is found in frames and points is in detections.csv");
    if (!session.imus.empty()) imu_ = recording_.imuSensor(session.referenceImu());
  }

  bool step() {
    if (!recording_.read(packet_)) {
      flush();
      cache_.finish();
      return false;
    }
    started_ = true;
    if (packet_.sensor == camera_) {
      pending_.insert(pending_.end(), packet_.events.begin(), packet_.events.end());
      if (pending_.size() >= kBatchEvents) flush();
    }
    if (imu_ && packet_.sensor == *imu_) {
      for (const ImuSample& sample : packet_.imu_samples)
        rotation_.add(secondsSince(start_ns_, sample.time_ns), sample.angular_rate_rad_s.norm());
    }
    return true;
  }

  void describe(RecordingOverview& overview) const {
    overview.started = started_;
    overview.start_ns = start_ns_;
    overview.resolution_px = resolution_px_;
    overview.read_until_s = last_ns_ >= start_ns_ ? secondsSince(start_ns_, last_ns_) : 0.0;
    overview.event_rate = events_.perSecond();
    overview.rotation_rate = rotation_.means();
    overview.fraction_read = recording_.fractionRead();
  }

 private:
  // The calibration's rules: sorted within a batch; late events and those outside are left out.
  void flush() {
    const auto earlier = [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; };
    if (!std::is_sorted(pending_.begin(), pending_.end(), earlier))
      std::stable_sort(pending_.begin(), pending_.end(), earlier);
    std::erase_if(pending_, [&](const Event& event) {
      return event.x_px >= resolution_px_.width_px || event.y_px >= resolution_px_.height_px ||
             event.time_ns < last_ns_;
    });
    if (pending_.empty()) return;
    cache_.append(pending_);
    last_ns_ = pending_.back().time_ns;
    for (const Event& event : pending_) events_.add(secondsSince(start_ns_, event.time_ns), 0.0);
    pending_.clear();
  }

  EventCache& cache_;
  SessionRecording recording_;
  std::size_t camera_;
  std::optional<std::size_t> imu_;
  Resolution resolution_px_;
  SensorPacket packet_;
  std::vector<Event> pending_;
  std::int64_t start_ns_;
  bool started_ = false;
  std::int64_t last_ns_ = std::numeric_limits<std::int64_t>::min();
  Bins events_, rotation_;
};

EventWindowReader::EventWindowReader(const Session& session, std::size_t camera,
                                     const std::filesystem::path& folder, std::function<void()> changed)
    : session_(session), camera_(camera), folder_(folder), published_(std::move(changed)) {}

RecordingOverview EventWindowReader::overview() const {
  const std::shared_ptr<const State> state = published_.take();
  return state ? state->overview : RecordingOverview{};
}

std::shared_ptr<const EventCache> EventWindowReader::cache() const {
  const std::shared_ptr<const State> state = published_.take();
  return state && state->overview.started ? state->cache : nullptr;
}

void EventWindowReader::publish() {
  published_.put(std::make_shared<State>(state_));
}

void EventWindowReader::readAll(const std::stop_token& stop) {
  state_.cache = std::make_shared<EventCache>(folder_);
  Pass pass(session_, camera_, *state_.cache);
  auto told = std::chrono::steady_clock::now();
  while (pass.step()) {
    if (stop.stop_requested()) return;
    if (std::chrono::steady_clock::now() - told < kTellEvery) continue;
    pass.describe(state_.overview);
    publish();
    told = std::chrono::steady_clock::now();
  }
  pass.describe(state_.overview);
  state_.overview.fraction_read = 1.0;
  state_.overview.finished = true;
  publish();
}

void EventWindowReader::read(const std::stop_token& stop) {
  try {
    readAll(stop);
    return;
  } catch (const CalibrationError& problem) {
    state_.overview.error = wordsOf(problem);
  } catch (const std::exception& problem) {
    state_.overview.error = problem.what();
  }
  publish();
}

}  // namespace evical::ui
