// Calibrations as in the desktop program - in a separate thread, observed through mailboxes, stopped by a
// token - but without Qt, so that the thread sanitizer sees every lock. Exit code 0 on success.
#include "core/base/error.h"
#include "core/data/calibration_observer.h"
#include "core/frontend/board_tracker.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "tests/support/simulated_recording.h"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

using namespace evical;

namespace {

constexpr auto kTick = std::chrono::milliseconds(5);

// The latest observation of each kind during a run; written by core's threads, read by the main thread.
class Mailbox : public ProgressSink, public CalibrationObserver {
 public:
  struct Contents {
    std::string stage;
    double fraction = 0.0;
    std::vector<std::string> lines, steps;
    std::shared_ptr<const BoardObservations> detections;
    std::shared_ptr<const CalibrationInput> input;
    std::shared_ptr<const CalibrationState> state;
    std::size_t iterations = 0, tracked = 0, searched = 0;
  };

  void stageStarted(const ProgressStage& stage) override {
    put([&](Contents& box) { box.stage = stage.name; });
  }
  void stageProgress(double fraction_of_stage) override {
    put([&](Contents& box) { box.fraction = fraction_of_stage; });
  }
  void log(LogLevel, std::string_view text) override {
    put([&](Contents& box) { box.lines.emplace_back(text); });
  }
  void windowsDetected(std::size_t, const BoardObservations& so_far) override {
    const auto copy = std::make_shared<const BoardObservations>(so_far);
    put([&](Contents& box) { box.detections = copy; });
  }
  void detectionDone(const CalibrationInput& input) override {
    const auto copy = std::make_shared<const CalibrationInput>(input);
    put([&](Contents& box) { box.input = copy; });
  }
  void initialisationStepDone(std::string_view step, std::string_view, std::string_view, double) override {
    put([&](Contents& box) { box.steps.emplace_back(step); });
  }
  void iterationDone(const IterationRecord&, const CalibrationState& state) override {
    const auto copy = std::make_shared<const CalibrationState>(state);
    put([&](Contents& box) {
      box.state = copy;
      ++box.iterations;
    });
  }
  template <class Change>
  void put(Change&& change) {
    const std::lock_guard lock(mutex_);
    change(contents_);
  }
  Contents look() const {
    const std::lock_guard lock(mutex_);
    return contents_;
  }

 private:
  mutable std::mutex mutex_;
  Contents contents_;
};

// Reads the tracker in the front end's thread, like the live view.
class Watcher final : public FrontEndObserver {
 public:
  Watcher(Mailbox& box, const BoardTracker& tracker) : box_(box), tracker_(tracker) {}
  void windowTracked(const BurstWindow&, const WindowTrace&) override {
    reports_ = tracker_.observations().windows;
    box_.put([](Mailbox::Contents& contents) { ++contents.tracked; });
  }
  void windowSearched(const BoardSearch&, std::int64_t) override {
    box_.put([](Mailbox::Contents& contents) { ++contents.searched; });
  }

 private:
  Mailbox& box_;
  const BoardTracker& tracker_;
  std::vector<WindowReport> reports_;
};

// A run's observer gives each camera's front end an object that lives as long as the run.
class WatchedMailbox final : public Mailbox {
 public:
  FrontEndObserver* windowObserver(std::size_t, const BoardTracker& tracker) override {
    return &watchers_.emplace_back(*this, tracker);
  }

 private:
  std::list<Watcher> watchers_;
};

struct Ending {
  CalibrationOutcome outcome;
  std::string problem;
  double after_stop_s = 0.0;
};

// Polls the mailbox until the job has ended; stops it as soon as `enough` is true for an observation.
Ending runJob(const Session& session, const std::function<bool(const Mailbox::Contents&)>& enough,
              WatchedMailbox& box) {
  Ending ending;
  std::atomic<bool> ended = false;
  std::stop_source stop;
  std::jthread worker([&ending, &ended, &box, session, token = stop.get_token()] {
    try {
      ending.outcome = runCalibration(session, RunContext{box, token, &box});
      if (ending.outcome.error) ending.problem = ending.outcome.error->what();
    } catch (const std::exception& error) {
      ending.outcome.status = RunStatus::Failed;
      ending.problem = std::string("not an outcome but thrown: ") + error.what();
    }
    ended = true;
  });
  auto stopped_at = std::chrono::steady_clock::time_point::max();
  while (!ended) {
    const Mailbox::Contents seen = box.look();
    if (seen.detections && seen.detections->windows.empty()) std::abort();
    if (enough(seen) && !stop.stop_requested()) {
      stop.request_stop();
      stopped_at = std::chrono::steady_clock::now();
    }
    std::this_thread::sleep_for(kTick);
  }
  worker.join();
  if (stop.stop_requested())
    ending.after_stop_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - stopped_at).count();
  return ending;
}

int failures = 0;

void check(bool holds, const char* what) {
  std::printf("%s: %s\n", holds ? "pass" : "FAIL", what);
  failures += holds ? 0 : 1;
}

void runToTheEnd(const Session& session) {
  WatchedMailbox box;
  const Ending ending = runJob(
      session, [](const auto&) { return false; }, box);
  const Mailbox::Contents seen = box.look();
  check(ending.outcome.status == RunStatus::Done && ending.outcome.run, "a calibration runs to its end");
  if (!ending.outcome.run) std::printf("      %s\n", ending.problem.c_str());
  check(seen.stage == "split_half_check" && seen.fraction >= 1.0, "its progress ends with the last stage");
  check(seen.detections && seen.input && seen.state && !seen.steps.empty(), "everything was seen on the way");
  check(seen.tracked > 0, "so were the windows");
}

void stopAt(const Session& session, const char* stage,
            const std::function<bool(const Mailbox::Contents&)>& reached) {
  WatchedMailbox box;
  const Ending ending = runJob(session, reached, box);
  check(ending.outcome.status == RunStatus::Cancelled && !ending.outcome.run, stage);
  std::printf("      stopped after %.3f s\n", ending.after_stop_s);
}

void fail(Session session) {
  session.imus.front().clock_offset_s = 1000.0;
  WatchedMailbox box;
  const Ending ending = runJob(
      session, [](const auto&) { return false; }, box);
  check(ending.outcome.status == RunStatus::Failed && ending.outcome.error && !ending.outcome.run,
        "a failure during the run is reported as a failure");
  check(!ending.outcome.detections.cameras.at(0).views.empty(), "with what was detected before it");
}

}  // namespace

int main() {
  try {
    const Session session = readSession(test::simulatedRecording("davis346", 4.0));
    runToTheEnd(session);
    stopAt(session, "stopped while it detects", [](const auto& seen) { return seen.detections != nullptr; });
    stopAt(session, "stopped while it initialises", [](const auto& seen) { return !seen.steps.empty(); });
    stopAt(session, "stopped while it optimises", [](const auto& seen) { return seen.iterations > 0; });
    fail(session);
  } catch (const std::exception& error) {
    check(false, error.what());
  }
  return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
