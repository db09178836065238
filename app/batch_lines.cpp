#include "app/batch_lines.h"

#include "app/output.h"

#include <fmt/format.h>

#include <unistd.h>

#include <string>

namespace evical {

BatchLines::BatchLines(std::size_t jobs, bool quiet)
    : jobs_(jobs), quiet_(quiet), on_terminal_(isatty(STDERR_FILENO) != 0) {}

BatchLines::~BatchLines() {
  clearLines();
}

void BatchLines::clearLines() {
  std::string text;
  for (; shown_ > 0; --shown_) text += "\033[A\033[2K";
  if (!text.empty()) clearTerminal(text);
}

void BatchLines::started(const BatchJob& job) {
  if (!quiet_ && !on_terminal_) printError(fmt::format("{}: started\n", job.name));
}

void BatchLines::ended(const BatchJob& job, const JobOutcome& outcome, bool earlier) {
  ++ended_;
  if (!earlier) ++ended_here_;
  if (quiet_) return;
  clearLines();
  const std::string how = outcome.end == JobEnd::Done ? std::string("done") : outcome.reason;
  printError(earlier ? fmt::format("{}: {}{}\n", job.name, how,
                                   outcome.end == JobEnd::Elsewhere ? "" : ", in an earlier run")
                     : fmt::format("{}: {}, {:.1f} s, {:.0f} MB ({} of {})\n", job.name, how, outcome.wall_s,
                                   outcome.peak_memory_mb, ended_, jobs_));
}

std::string BatchLines::summary() const {
  if (ended_here_ == 0) return fmt::format("{} of {} jobs", ended_, jobs_);
  const double left_s =
      of_all_.elapsed_s() / static_cast<double>(ended_here_) * static_cast<double>(jobs_ - ended_);
  return fmt::format("{} of {} jobs, about {:.0f} s left", ended_, jobs_, left_s);
}

void BatchLines::running(std::span<const RunningJob> jobs) {
  constexpr double kRefresh_s = 0.2;
  if (quiet_ || !on_terminal_ || since_shown_.elapsed_s() < kRefresh_s) return;
  since_shown_.restart_s();
  clearLines();
  constexpr std::size_t kWidest = 60;
  std::string text;
  for (const RunningJob& each : jobs)
    text += fmt::format("{}: {:.0f} s, {}\n", each.job->name, each.elapsed_s, each.stage.substr(0, kWidest));
  printError(text + summary() + "\n");
  shown_ = jobs.size() + 1;
}

}  // namespace evical
