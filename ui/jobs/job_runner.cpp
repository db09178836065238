// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/job_runner.h"

#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/base/in_parallel.h"
#include "core/base/plain_text.h"
#include "core/base/time.h"
#include "core/recording/separate_reader.h"

#include <QMetaObject>

#include <algorithm>
#include <exception>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <utility>

namespace evical::ui {
namespace {

constexpr int kTick_ms = 40;

QString textOf(std::string_view text) {
  return QString::fromUtf8(text.data(), static_cast<qsizetype>(text.size()));
}

JobError internalError(const QString& what) {
  return {false, QObject::tr("internal error"), what,
          QObject::tr("Report this error, with the log and the session file")};
}

struct Ending {
  JobOutcome outcome = JobOutcome::Done;
  std::optional<JobError> error;
};

Ending runToEnd(const JobRunner::Work& work, const RunContext& context) {
  try {
    work(context);
    return {};
  } catch (const Cancelled&) {
    return {JobOutcome::Cancelled, {}};
  } catch (const CalibrationError& error) {
    return {JobOutcome::Failed, errorOf(error)};
  } catch (const std::bad_alloc&) {
    return {JobOutcome::Failed, JobError{false, QObject::tr("memory"), QObject::tr("not enough is available"),
                                         QObject::tr("Close other programs, or limit the time range")}};
  } catch (const std::exception& error) {
    return {JobOutcome::Failed, internalError(QString::fromUtf8(error.what()))};
  } catch (...) {
    return {JobOutcome::Failed, internalError(QObject::tr("an exception of unknown type"))};
  }
}

}  // namespace

JobError errorOf(const CalibrationError& error) {
  return {error.kind() == ErrorKind::BadInput, textOf(error.place()), textOf(error.problem()),
          textOf(error.advice()), error.repair()};
}

QString JobError::text() const {
  QString text = place.isEmpty() ? problem : place + ": " + problem;
  if (!advice.isEmpty()) text += (text.endsWith('.') ? " " : ". ") + advice;
  return text;
}

// Unread messages of the worker to the GUI thread. The worker's side may outlive the runner's.
struct JobRunner::Reports final : ProgressSink {
  explicit Reports(std::vector<JobStage> given) : stages(std::move(given)) {}

  void stageStarted(const ProgressStage& started) override {
    const std::lock_guard lock(mutex);
    stage = started;
    new_stages.push_back(textOf(stage.name));
    setFraction(0.0);
    log_text += QString::asprintf("%9.3f s  stage    ", stopwatch.elapsed_s()) + textOf(stage.text()) + "\n";
  }
  void stageProgress(double of_stage) override {
    const std::lock_guard lock(mutex);
    setFraction(of_stage);
  }
  void log(LogLevel level, std::string_view text) override {
    const std::lock_guard lock(mutex);
    lines.push_back({level, stopwatch.elapsed_s(), shown(text)});
    log_text +=
        QString::asprintf("%9.3f s  %-7s  ", stopwatch.elapsed_s(), levelName(level)) + shown(text) + "\n";
  }

  static QString shown(std::string_view text) { return textOf(visible(text, "\n")); }

  // Stages that were not announced do not count.
  void setFraction(double of_stage) {
    stage_fraction = std::clamp(of_stage, 0.0, 1.0);
    double before = 0.0, total = 0.0, own = 0.0;
    bool passed = false;
    for (const JobStage& candidate : stages) {
      total += candidate.share;
      if (candidate.stage == stage) {
        own = candidate.share;
        passed = true;
      }
      if (!passed) before += candidate.share;
    }
    if (passed && total > 0.0) fraction = std::max(fraction, (before + own * stage_fraction) / total);
  }

  // Extrapolates the mean pace; negative at the beginning.
  double remaining_s() const {
    constexpr double kEnough = 0.03;
    return fraction < kEnough ? -1.0 : stopwatch.elapsed_s() * (1.0 - fraction) / fraction;
  }

  std::mutex mutex;
  const Stopwatch stopwatch;
  const std::vector<JobStage> stages;
  ProgressStage stage{""};
  QString log_text;
  double stage_fraction = 0.0, fraction = 0.0;
  std::vector<QString> new_stages;
  std::vector<LogLine> lines;
  Ending ending;
};

JobRunner::JobRunner(QObject* parent) : QObject(parent) {
  qRegisterMetaType<JobError>();
  qRegisterMetaType<JobOutcome>();
  qRegisterMetaType<JobProgress>();
  qRegisterMetaType<LogLine>();
  timer_.setInterval(kTick_ms);
  connect(&timer_, &QTimer::timeout, this, &JobRunner::tick);
}

JobRunner::~JobRunner() {
  stop_.request_stop();
  if (thread_.joinable()) thread_.join();
}

QString JobRunner::logText() const {
  if (!reports_) return {};
  const std::lock_guard lock(reports_->mutex);
  return reports_->log_text;
}

bool JobRunner::start(const QString& title, std::vector<JobStage> stages, Work work) {
  if (running_) return false;
  if (thread_.joinable()) thread_.join();
  title_ = title;
  stop_ = std::stop_source();
  reports_ = std::make_shared<Reports>(std::move(stages));
  running_ = true;
  emit started(title_);
  timer_.start();
  thread_ =
      std::jthread([this, reports = reports_, stop = stop_.get_token(), job = std::move(work)]() mutable {
        makeThreadModest();
        const StopWaiting until_stop(stop);
        Ending ending = runToEnd(job, RunContext{*reports, stop});
        job = nullptr;  // its data are released before its end is signalled
        {
          const std::lock_guard lock(reports->mutex);
          reports->ending = std::move(ending);
        }
        QMetaObject::invokeMethod(this, &JobRunner::finish, Qt::QueuedConnection);
      });
  return true;
}

void JobRunner::cancel() {
  if (running_) stop_.request_stop();
}

void JobRunner::tick() {
  std::vector<QString> stages;
  std::vector<LogLine> lines;
  JobProgress progress;
  {
    const std::lock_guard lock(reports_->mutex);
    stages.swap(reports_->new_stages);
    lines.swap(reports_->lines);
    progress = {textOf(reports_->stage.name), textOf(reports_->stage.part),    reports_->stage_fraction,
                reports_->fraction,           reports_->stopwatch.elapsed_s(), reports_->remaining_s()};
  }
  for (const QString& stage : stages) emit stageStarted(stage);
  for (const LogLine& line : lines) emit logged(line);
  emit progressed(progress);
  emit ticked();
}

void JobRunner::finish() {
  timer_.stop();
  thread_.join();
  tick();
  running_ = false;
  const Ending ending = reports_->ending;
  if (ending.error) emit failed(*ending.error);
  emit finished(ending.outcome);
  // After the end: it takes as long as a cancelled job may take in all.
  // A job's freed memory is more than all the rest, and is kept otherwise.
  if (!running_) thread_ = std::jthread(giveBackFreeMemory);
}

}  // namespace evical::ui
