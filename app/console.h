// Terminal output of a run: progress line, log for log.txt, Ctrl-C.
#pragma once

#include "core/base/progress.h"
#include "core/base/time.h"
#include "core/pipeline/batch/batch_run.h"

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <mutex>
#include <stop_token>
#include <string>

namespace evical {

// Rewrites a progress line on a terminal; otherwise prints plain lines, or nothing if quiet. Records the log.
class Console final : public ProgressSink {
 public:
  explicit Console(bool quiet);
  ~Console() override;

  void stageStarted(const ProgressStage& stage) override;
  void stageProgress(double fraction_of_stage) override;
  void log(LogLevel level, std::string_view text) override;

  // Warns that an earlier result of these names in the folder will be replaced. Files are replaced together,
  // when the new ones are complete.
  void announceReplacement(const std::filesystem::path& folder, std::initializer_list<const char*> names);

  const std::string& logText() const { return log_text_; }

 private:
  void clearLine();

  std::mutex mutex_;
  bool quiet_, on_terminal_;
  bool line_shown_ = false;
  std::string stage_, log_text_;
  Stopwatch of_all_, of_stage_, since_shown_;
};

// SIGINT and SIGTERM request a stop of the returned token; a second signal ends the program immediately.
std::stop_token stopOnSignals();

// Progress of a batch: one line per running job, rewritten on a terminal; otherwise a line at the start and
// the end of each job.
class BatchLines final : public BatchWatcher {
 public:
  BatchLines(std::size_t jobs, bool quiet);
  ~BatchLines() override;

  void started(const BatchJob& job) override;
  void ended(const BatchJob& job, const JobOutcome& outcome, bool earlier) override;
  void running(std::span<const RunningJob> jobs) override;

 private:
  void clearLines();
  std::string summary() const;

  std::size_t jobs_, ended_ = 0, ended_here_ = 0;
  bool quiet_, on_terminal_;
  std::size_t shown_ = 0;  // number of lines currently shown
  Stopwatch of_all_, since_shown_;
};

}  // namespace evical
