#include "app/console.h"

#include "app/output.h"

#include "core/base/file_places.h"
#include "core/base/plain_text.h"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <string>
#include <thread>

namespace evical {
namespace {

std::stop_source& stopSource() {
  static std::stop_source source;
  return source;
}

}  // namespace

Console::Console(bool quiet) : quiet_(quiet), on_terminal_(isatty(STDERR_FILENO) != 0) {}

Console::~Console() {
  const std::lock_guard lock(mutex_);
  clearLine();
}

void Console::clearLine() {
  if (line_shown_) clearTerminal("\r\033[K");
  line_shown_ = false;
}

void Console::stageStarted(const ProgressStage& stage) {
  const std::lock_guard lock(mutex_);
  stage_ = stage.text();
  of_stage_.restart_s();
  log_text_ += fmt::format("{:9.3f} s  stage    {}\n", of_all_.elapsed_s(), stage_);
  if (quiet_) return;
  clearLine();
  if (!on_terminal_) printError(fmt::format("{} ...\n", stage_));
}

void Console::stageProgress(double fraction) {
  constexpr double kRefresh_s = 0.1;
  const std::lock_guard lock(mutex_);
  if (quiet_ || !on_terminal_ || since_shown_.elapsed_s() < kRefresh_s) return;
  since_shown_.restart_s();
  const double elapsed_s = of_stage_.elapsed_s();
  std::string left;
  if (fraction > 0.02) left = fmt::format(", {:.0f} s left", elapsed_s * (1.0 - fraction) / fraction);
  clearTerminal("\r\033[K");
  printError(fmt::format("{}: {:3.0f} %{}", stage_, 100.0 * fraction, left));
  std::fflush(stderr);
  line_shown_ = true;
}

void Console::log(LogLevel level, std::string_view text) {
  const std::lock_guard lock(mutex_);
  log_text_ +=
      fmt::format("{:9.3f} s  {:<7}  {}\n", of_all_.elapsed_s(), levelName(level), visible(text, "\n"));
  if (quiet_ || level == LogLevel::Debug) return;
  clearLine();
  printError(fmt::format("{}{}\n", level == LogLevel::Warning ? "warning: " : "  ", text));
}

void Console::announceReplacement(const std::filesystem::path& folder,
                                  std::initializer_list<const char*> names) {
  for (const char* const name : names)
    if (pathExists(folder / name))
      log(LogLevel::Warning,
          fmt::format(
              "{} exists: this run replaces it when it has a new one. To keep it, give another output",
              (folder / name).string()));
}

std::stop_token stopOnSignals() {
  stopSource();
  // stop_source::request_stop is not safe in a signal handler, so a thread waits for the signal.
  static sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread([] {
    int signal = 0;
    sigwait(&signals, &signal);
    stopSource().request_stop();
    sigwait(&signals, &signal);
    constexpr int kCancelled = 1;
    _exit(kCancelled);
  }).detach();
  return stopSource().get_token();
}

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
