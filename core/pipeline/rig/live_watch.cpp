#include "core/pipeline/rig/live_watch.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/base/time.h"
#include "core/data/calibration_observer.h"
#include "core/data/imu_stamps.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/recording/live/growth.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

namespace evical {
namespace {

constexpr std::chrono::milliseconds kBetweenAssessments{500};

// The recording is the file that is written.
Session sessionOf(const WatchRequest& request) {
  Session session = request.session;
  session.recording = std::filesystem::absolute(request.record.output);
  session.time_range_s.reset();
  for (SessionCamera& camera : session.cameras) camera.recording.clear();
  for (SessionImu& imu : session.imus) imu.recording.clear();
  for (const SessionCamera& camera : session.cameras)
    if (!session.sensor(static_cast<std::size_t>(&camera - session.cameras.data())).intrinsics)
      throw badInput(camera.name, "its lens is not given, so the board cannot be tracked live",
                     "Calibrate the camera alone first " + howTo(HowTo::CalibrateLens));
  return session;
}

// Detections so far, copied only when somebody asks.
class Snapshots : public CalibrationObserver {
 public:
  Snapshots(const Session& session, std::vector<CameraLens> lenses, std::size_t cameras)
      : session_(session), lenses_(std::move(lenses)), cameras_(cameras), is_fresh_(cameras) {}

  void windowsDetected(std::size_t camera, const BoardObservations& so_far) override {
    const std::scoped_lock lock(mutex_);
    last_window_s_ = so_far.windows.empty() ? 0.0 : so_far.windows.back().time_s;
    if (!wanted_ || is_fresh_[camera]) return;
    cameras_[camera] = so_far;
    cameras_[camera].camera = session_.cameras[camera].name;
    is_fresh_[camera] = true;
    arrived_.notify_all();
  }

  void samplesRead(const DetectionResult& so_far) {
    const std::scoped_lock lock(mutex_);
    if (!wanted_ || are_samples_fresh_) return;
    start_ns_ = so_far.start_ns;
    imus_ = so_far.imus;
    resolutions_px_ = so_far.resolutions_px;
    are_samples_fresh_ = true;
    arrived_.notify_all();
  }

  // Asks and waits; nothing after a stop.
  std::optional<DetectedRecording> take(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    wanted_ = true;
    is_fresh_.assign(is_fresh_.size(), false);
    are_samples_fresh_ = session_.imus.empty();
    const bool complete = arrived_.wait(lock, stop, [this] {
      return are_samples_fresh_ && std::ranges::all_of(is_fresh_, [](bool fresh) { return fresh; });
    });
    wanted_ = false;
    if (!complete) return std::nullopt;
    DetectedRecording so_far;
    so_far.detections.start_ns = start_ns_;
    so_far.detections.cameras = cameras_;
    so_far.detections.lenses = lenses_;
    so_far.detections.imus = imus_;
    so_far.detections.resolutions_px = resolutions_px_;
    for (std::size_t k = 0; k < imus_.size(); ++k) {
      ImuData& imu = so_far.detections.imus[k];
      imu.name = session_.imus[k].name;
      imu.noise = session_.imus[k].noise;
      std::vector<RecordingFault> later;
      if (!imu.samples.empty())
        static_cast<void>(putInOrder(session_.imus[k].joinedStream(), imu.samples.front().time_ns,
                                     imu.samples, later, *session_.options.stamps));
    }
    return so_far;
  }

  double lastWindow_s() {
    const std::scoped_lock lock(mutex_);
    return last_window_s_;
  }

 private:
  const Session& session_;
  std::vector<CameraLens> lenses_;
  std::mutex mutex_;
  std::condition_variable_any arrived_;
  bool wanted_ = false, are_samples_fresh_ = false;
  std::vector<BoardObservations> cameras_;
  std::vector<bool> is_fresh_;  // by camera
  std::vector<ImuData> imus_;
  std::vector<Resolution> resolutions_px_;
  std::int64_t start_ns_ = 0;
  double last_window_s_ = 0.0;
};

// Sigmas shrink with the root of the time.
std::optional<double> untilGood_s(const RecordingAssessment& assessment, const Session& session,
                                  double recorded_s) {
  if (assessment.sigmas.empty()) return std::nullopt;
  const OptimisationOptions& needed = *session.options.optimisation;
  double worst = 0.0;
  for (const ExpectedSigmas& sigmas : assessment.sigmas)
    worst = std::max({worst, sigmas.rotation_deg / needed.needed_rotation_deg,
                      sigmas.translation_mm / needed.needed_translation_mm,
                      sigmas.time_offset_ms / needed.needed_time_offset_ms});
  return std::max(0.0, recorded_s * (worst * worst - 1.0));
}

class Watch {
 public:
  Watch(const WatchRequest& request, LiveWatcher& watcher, const RunContext& context)
      : request_(request), watcher_(watcher), context_(context), session_(sessionOf(request)) {}
  ~Watch() { end_.request_stop(); }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  WatchedRecording run();

 private:
  void record();
  bool awaitFile();
  void assess(Snapshots& snapshots, const std::stop_token& stop);

  const WatchRequest& request_;
  LiveWatcher& watcher_;
  const RunContext& context_;
  Session session_;
  std::stop_source end_;  // of the recording
  std::shared_ptr<Growth> growth_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_open_ = false, is_recorded_ = false;
  double recorded_s_ = 0.0;
  LiveSummary summary_;
  std::exception_ptr failure_;
  bool good_ = false;
  std::jthread recording_;
};

void Watch::record() {
  LiveRequest request = request_.record;
  request.progressed = [this](double recorded_s) {
    const std::scoped_lock lock(mutex_);
    is_open_ = true;
    recorded_s_ = recorded_s;
    changed_.notify_all();
  };
  LiveSummary summary;
  std::exception_ptr failure;
  try {
    summary = recordLive(request, {context_.progress, end_.get_token(), nullptr});
  } catch (...) {
    failure = std::current_exception();
  }
  growth_->end();
  const std::scoped_lock lock(mutex_);
  summary_ = std::move(summary);
  failure_ = failure;
  is_recorded_ = true;
  changed_.notify_all();
}

// False if the recording ended before it began.
bool Watch::awaitFile() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return is_open_ || is_recorded_; });
  return is_open_;
}

void Watch::assess(Snapshots& snapshots, const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::this_thread::sleep_for(kBetweenAssessments);
    const std::optional<DetectedRecording> so_far = snapshots.take(stop);
    if (!so_far) return;
    LiveState state;
    try {
      state.assessment = assessRecording(session_, *so_far, {silentProgress(), stop, nullptr});
    } catch (const CalibrationError&) {
      continue;  // too early
    } catch (const Cancelled&) {
      return;
    }
    {
      const std::scoped_lock lock(mutex_);
      state.recorded_s = recorded_s_;
    }
    state.behind_s = std::max(0.0, state.recorded_s - snapshots.lastWindow_s());
    state.until_good_s = untilGood_s(state.assessment, session_, state.recorded_s);
    state.instruction = instructionFor(state.assessment, state.recorded_s, state.until_good_s);
    watcher_.assessed(state);
    good_ = state.assessment.light == Light::Good;
    if (good_ && request_.until_good) {
      end_.request_stop();
      return;
    }
  }
}

WatchedRecording Watch::run() {
  growth_ = std::make_shared<Growth>(session_.recording, Growth::EndsBy::Writer);
  const std::stop_callback on_stop(context_.stop, [this] { end_.request_stop(); });
  recording_ = std::jthread([this] { record(); });
  WatchedRecording result;
  if (awaitFile()) {
    const std::vector<CameraLens> lenses = givenLenses(session_);
    Snapshots snapshots(session_, lenses, session_.cameras.size());
    const LivePass live{growth_, [&](const DetectionResult& so_far) { snapshots.samplesRead(so_far); }};
    std::jthread assessing([&](const std::stop_token& stop) { assess(snapshots, stop); });
    // A stop ends the recording; the pass still reads what was recorded.
    result.detected.detections = readAndDetect(session_, lenses, {silentProgress(), {}, &snapshots}, &live);
  }
  recording_.join();
  if (failure_) std::rethrow_exception(failure_);
  result.recorded = std::move(summary_);
  result.session = session_;
  result.is_good = good_;
  return result;
}

}  // namespace

std::string instructionFor(const RecordingAssessment& assessment, double recorded_s,
                           std::optional<double> until_good_s) {
  constexpr double kBeginning_s = 3.0, kSoon_s = 20.0;
  // The order in which things help: what is not seen cannot be measured.
  constexpr std::array kMotion = {AssessedThing::Board, AssessedThing::Speed, AssessedThing::Turns,
                                  AssessedThing::Accelerations, AssessedThing::Coverage};
  constexpr std::array kPrecision = {AssessedThing::Rotation, AssessedThing::Translation,
                                     AssessedThing::TimeOffset, AssessedThing::Obstacle};
  const auto adviceOn = [&](const auto& things) {
    for (const AssessedThing thing : things)
      for (const Assessed& each : assessment.all)
        if (each.thing == thing && each.light != Light::Good) return each.advice;
    return std::string();
  };
  if (recorded_s < kBeginning_s) return {};
  if (std::string advice = adviceOn(kMotion); !advice.empty()) return advice;
  // Everything moves as it should, so that time is all that is missing.
  if (!until_good_s || *until_good_s <= kSoon_s)
    return assessment.light == Light::Good ? "" : "Go on like this.";
  return adviceOn(kPrecision);
}

WatchedRecording watchLive(const WatchRequest& request, LiveWatcher& watcher, const RunContext& context) {
  return Watch(request, watcher, context).run();
}

}  // namespace evical
