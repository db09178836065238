#include "core/pipeline/batch/batch_run.h"

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/pipeline/session/session.h"
#include "core/pipeline/session/session_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <deque>
#include <fstream>
#include <list>
#include <system_error>
#include <thread>
#include <utility>

namespace evical {
namespace {

constexpr double kPatience_s = 10.0;  // until a job that was asked to end is killed
constexpr std::chrono::milliseconds kBetweenLooks(50);

// Last line that is not empty. Only the end of the file is read.
std::string lastLineOf(const std::filesystem::path& file) {
  constexpr std::streamoff kTail_bytes = 4096;
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  const std::streamoff size_bytes = stream.tellg();
  stream.seekg(std::max<std::streamoff>(0, size_bytes - kTail_bytes));
  std::string line, last;
  while (std::getline(stream, line))
    if (line.find_first_not_of(" \r") != std::string::npos) last = line;
  return last;
}

// Session file for the job's process: its own, or a copy with the job's recording.
std::filesystem::path sessionFor(const BatchJob& job, const std::filesystem::path& folder) {
  if (job.recording.empty()) return job.session;
  Session session = withoutRejectedWindows(readSessionOfRun(job.session));
  std::error_code ignored;
  if (!std::filesystem::exists(job.recording, ignored))
    throw badInput(job.recording.string(), "does not exist",
                   "Check the path: paths are relative to the batch file");
  session.recording = job.recording;
  session.more_recordings.clear();
  const std::filesystem::path file = jobFile(folder, job, ".session.yaml");
  writeSession(session, file);
  return file;
}

JobOutcome outcomeOf(const ProcessEnd& end, const std::string& last_line, int memory_limit_mb, bool asked) {
  constexpr int kDone = 0, kBadInput = 2;
  JobOutcome outcome{JobEnd::Failed, last_line, end.wall_s, end.peak_memory_mb, {}};
  if (end.exit_code == kDone) {
    outcome.end = JobEnd::Done;
    outcome.reason.clear();
  } else if (asked) {
    outcome.end = JobEnd::Cancelled;
    outcome.reason = "cancelled";
  } else if (end.signal != 0) {
    outcome.end = JobEnd::Killed;
    outcome.reason =
        fmt::format("was terminated by signal {}{}", end.signal,
                    end.signal == SIGKILL ? ", possibly because of insufficient memory or a shutdown" : "");
  } else if (memory_limit_mb > 0 && last_line.find("not enough memory") != std::string::npos) {
    outcome.end = JobEnd::OutOfMemory;
    outcome.reason = fmt::format("needs more memory than the limit of {} MB", memory_limit_mb);
  } else if (end.exit_code == kBadInput) {
    outcome.end = JobEnd::BadInput;
  } else if (last_line == "cancelled") {
    outcome.end = JobEnd::Cancelled;
  }
  return outcome;
}

class BatchRunner {
 public:
  BatchRunner(const Batch& batch, const BatchPlace& place, BatchWatcher& watcher, std::stop_token stop)
      : batch_(batch),
        place_(place),
        watcher_(watcher),
        stop_(std::move(stop)),
        outcomes_(batch.jobs.size()) {
    for (std::size_t k = 0; k < batch.jobs.size(); ++k) waiting_.push_back(k);
  }

  std::vector<JobOutcome> run() {
    while (!waiting_.empty() || !running_.empty()) {
      if (stop_.stop_requested()) waiting_.clear();
      startSome();
      collectEnded();
      reportRunning();
      if (!running_.empty() || !waiting_.empty()) std::this_thread::sleep_for(kBetweenLooks);
    }
    return std::move(outcomes_);
  }

 private:
  struct Process {
    std::size_t job;
    FileLock lock;
    ChildProcess process;
    std::vector<std::string> inputs;
  };

  void startSome() {
    for (std::size_t left = waiting_.size(); left > 0; --left) {
      if (running_.size() >= static_cast<std::size_t>(batch_.at_once)) return;
      const std::size_t k = waiting_.front();
      waiting_.pop_front();
      if (startOrSettle(k)) continue;
      if (place_.wait_for_others)
        waiting_.push_back(k);
      else
        reportEnd(k, {JobEnd::Elsewhere, "another process runs this job", 0.0, 0.0, {}}, true);
    }
  }

  // False if another process runs it.
  bool startOrSettle(std::size_t k) {
    const BatchJob& job = batch_.jobs[k];
    FileLock lock(jobFile(place_.folder, job, ".lock"));
    if (!lock.taken()) return false;
    if (std::optional<JobOutcome> earlier = readOutcome(place_.folder, job);
        earlier && isSettled(place_.folder, job, *earlier)) {
      reportEnd(k, std::move(*earlier), true);
      return true;
    }
    std::vector<std::string> inputs = inputsOf(job);
    try {
      ChildProcess process = started(job, lock);
      watcher_.started(job);
      running_.push_back({k, std::move(lock), std::move(process), std::move(inputs)});
    } catch (const CalibrationError& error) {
      const JobEnd end = error.kind() == ErrorKind::BadInput ? JobEnd::BadInput : JobEnd::Failed;
      keepEnd(k, {end, error.what(), 0.0, 0.0, std::move(inputs)});
    }
    return true;
  }

  ChildProcess started(const BatchJob& job, const FileLock& lock) const {
    std::error_code ignored;
    std::filesystem::remove(jobFile(place_.folder, job, ".yaml"), ignored);
    removeLinksWithin(place_.folder, job.name);
    removeLinksWithin(jobFile(place_.folder, job, ".log").parent_path(), job.name + ".log");
    ProcessStart start;
    start.command = {place_.program.string(),
                     "calibrate",
                     sessionFor(job, place_.folder).string(),
                     "-o",
                     (place_.folder / job.name).string(),
                     "--threads",
                     std::to_string(batch_.threads)};
    for (const std::string& setting : job.settings)
      start.command.insert(start.command.end(), {"--set", setting});
    start.output = jobFile(place_.folder, job, ".log");
    start.memory_limit_bytes = std::int64_t{batch_.memory_limit_mb} * 1'000'000;
    start.kept_descriptor = lock.descriptor();
    return ChildProcess(start);
  }

  void collectEnded() {
    const bool asked = stop_.stop_requested();
    for (auto at = running_.begin(); at != running_.end();) {
      if (asked) at->process.stop(kPatience_s);
      const std::optional<ProcessEnd> end = at->process.ended();
      if (!end) {
        ++at;
        continue;
      }
      const BatchJob& job = batch_.jobs[at->job];
      JobOutcome outcome =
          outcomeOf(*end, lastLineOf(jobFile(place_.folder, job, ".log")), batch_.memory_limit_mb, asked);
      outcome.inputs = std::move(at->inputs);
      keepEnd(at->job, std::move(outcome));
      at = running_.erase(at);
    }
  }

  void reportRunning() {
    std::vector<RunningJob> shown;
    for (const Process& each : running_) {
      const BatchJob& job = batch_.jobs[each.job];
      shown.push_back({&job, each.process.elapsed_s(), lastLineOf(jobFile(place_.folder, job, ".log"))});
    }
    watcher_.running(shown);
  }

  void keepEnd(std::size_t k, JobOutcome outcome) {
    writeOutcome(place_.folder, batch_.jobs[k], outcome);
    reportEnd(k, std::move(outcome), false);
  }
  void reportEnd(std::size_t k, JobOutcome outcome, bool earlier) {
    outcomes_[k] = std::move(outcome);
    watcher_.ended(batch_.jobs[k], outcomes_[k], earlier);
  }

  const Batch& batch_;
  const BatchPlace& place_;
  BatchWatcher& watcher_;
  std::stop_token stop_;
  std::deque<std::size_t> waiting_;
  std::list<Process> running_;
  std::vector<JobOutcome> outcomes_;
};

}  // namespace

void makeBatchFolder(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (std::filesystem::exists(folder / "result.yaml", ignored))
    throw badInput(folder.string(), "contains the result of a calibration", "Choose another folder");
  makeOutputFolder(folder);
  makeFolderWithin(folder, "jobs");
}

std::vector<JobOutcome> runBatch(const Batch& batch, const BatchPlace& place, BatchWatcher& watcher,
                                 std::stop_token stop) {
  return BatchRunner(batch, place, watcher, std::move(stop)).run();
}

std::vector<JobOutcome> collectBatch(const Batch& batch, const std::filesystem::path& folder) {
  std::vector<JobOutcome> outcomes;
  for (const BatchJob& job : batch.jobs) {
    std::optional<JobOutcome> outcome = readOutcome(folder, job);
    outcomes.push_back(outcome && outcome->inputs == inputsOf(job) ? *std::move(outcome) : JobOutcome{});
  }
  return outcomes;
}

}  // namespace evical
