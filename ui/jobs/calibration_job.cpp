// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/calibration_job.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <utility>

namespace evical::ui {
namespace {

using Clock = std::chrono::steady_clock;

// Copies of all detections so far: often enough to look alive, seldom enough to cost nothing.
constexpr auto kBetweenDetections = std::chrono::milliseconds(150);

std::vector<JobStage> jobStages(RunStart start) {
  std::vector<JobStage> stages;
  for (const StageRow& row : kCalibrationStages)
    if (shareOf(row, start) > 0.0) stages.push_back({row.name, shareOf(row, start)});
  return stages;
}

QString textOf(std::string_view text) {
  return QString::fromUtf8(text.data(), static_cast<qsizetype>(text.size()));
}

}  // namespace

// The mailbox between core's threads and the GUI: holds the newest of everything, and hands it out once.
class CalibrationJob::LiveView final : public CalibrationObserver {
 public:
  struct Contents {
    std::shared_ptr<const LiveDetections> detections;
    bool detection_done = false;
    std::vector<InitialisationNote> notes;
    std::shared_ptr<const LiveIterations> iterations;
  };

  LiveView(std::size_t cameras, std::shared_ptr<CalibrationObserver> windows)
      : windows_(std::move(windows)), detections_(cameras) {}

  FrontEndObserver* windowObserver(std::size_t camera, const BoardTracker& tracker) override {
    return windows_ ? windows_->windowObserver(camera, tracker) : nullptr;
  }
  void windowsDetected(std::size_t camera, const BoardObservations& so_far) override {
    if (Clock::now() < next_copy_) return;
    next_copy_ = Clock::now() + kBetweenDetections;
    detections_.at(camera) = so_far;
    put([&](Contents& box) { box.detections = std::make_shared<LiveDetections>(detections_); });
  }
  void detectionDone(const CalibrationInput&) override {
    put([](Contents& box) { box.detection_done = true; });
  }
  void initialisationStepDone(std::string_view step, std::string_view result, double duration_s) override {
    put([&](Contents& box) { box.notes.push_back({textOf(step), textOf(result), duration_s}); });
  }
  void iterationDone(const IterationRecord& iteration, const CalibrationState& state) override {
    records_.push_back(iteration);
    const auto copy = std::make_shared<LiveIterations>(LiveIterations{records_, state});
    put([&](Contents& box) { box.iterations = copy; });
  }

  Contents take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(contents_, {});
  }

  std::shared_ptr<const CalibrationRun> run;  // written by the work, read once it has ended

 private:
  template <class Change>
  void put(Change&& change) {
    const std::lock_guard lock(mutex_);
    change(contents_);
  }

  std::shared_ptr<CalibrationObserver> windows_;
  LiveDetections detections_;
  std::vector<IterationRecord> records_;
  Clock::time_point next_copy_;
  std::mutex mutex_;
  Contents contents_;
};

CalibrationJob::CalibrationJob(JobRunner& runner, QObject* parent) : QObject(parent), runner_(runner) {
  qRegisterMetaType<InitialisationNote>();
  connect(&runner_, &JobRunner::ticked, this, &CalibrationJob::deliver);
  connect(&runner_, &JobRunner::finished, this, &CalibrationJob::finish);
}

bool CalibrationJob::start(const Session& session) {
  const auto windows = make_observer_ && !runner_.running() ? make_observer_() : nullptr;
  const bool all_known = std::all_of(session.cameras.begin(), session.cameras.end(),
                                     [](const SessionCamera& camera) { return camera.intrinsics; });
  const RunStart from = all_known ? RunStart::KnownIntrinsics : RunStart::UnknownIntrinsics;
  const bool begun = run(session, from, windows,
                         [session](const RunContext& context) { return calibrate(session, context); });
  if (begun) emit detecting();
  return begun;
}

bool CalibrationJob::startAgain(const Session& session, RecordingPass pass,
                                std::vector<std::optional<IntrinsicsResult>> intrinsics) {
  const auto shared = std::make_shared<RecordingPass>(std::move(pass));
  return run(session, RunStart::Detections, nullptr,
             [session, shared, intrinsics = std::move(intrinsics)](const RunContext& context) {
               return calibrate(session, std::move(*shared), context, intrinsics);
             });
}

bool CalibrationJob::run(const Session& session, RunStart start, std::shared_ptr<CalibrationObserver> windows,
                         Work work) {
  if (runner_.running()) return false;
  session_ = session;
  live_ = std::make_shared<LiveView>(session.cameras.size(), std::move(windows));
  const auto job = [work = std::move(work), live = live_](const RunContext& context) {
    live->run =
        std::make_shared<CalibrationRun>(work(RunContext{context.progress, context.stop, live.get()}));
  };
  if (!runner_.start(tr("Calibrate"), jobStages(start), job)) return false;
  emit started();
  return true;
}

void CalibrationJob::deliver() {
  if (!live_) return;
  const LiveView::Contents fresh = live_->take();
  if (fresh.detections) emit detectionsChanged(fresh.detections);
  if (fresh.detection_done) emit detectionDone();
  for (const InitialisationNote& note : fresh.notes) emit initialisationStepDone(note);
  if (fresh.iterations) emit iterationsChanged(fresh.iterations);
}

void CalibrationJob::finish(JobOutcome outcome) {
  const std::shared_ptr<LiveView> live = std::exchange(live_, nullptr);
  if (live) emit ended();
  if (!live || outcome != JobOutcome::Done) return;
  emit calibrated(live->run, session_, runner_.logText());
}

}  // namespace evical::ui
