// SPDX-License-Identifier: GPL-3.0-or-later
// Runs one long job at a time in a separate thread. The job owns copies of its inputs; its progress reaches
// the GUI thread a few times a second, its outcome always and exactly once.
#pragma once

#include "core/base/error.h"
#include "core/base/progress.h"

#include <QObject>
#include <QString>
#include <QTimer>

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <thread>
#include <vector>

namespace evical::ui {

// Problem, place and advice.
struct JobError {
  bool bad_input = false;  // the user can correct it: session, recording, options
  QString place, problem, advice;
  std::optional<Repair> repair = {};

  QString text() const;
};

JobError errorOf(const CalibrationError& error);

enum class JobOutcome { Done, Cancelled, Failed };

// A stage by its name (ProgressSink::stageStarted), and its share of the total time.
struct JobStage {
  ProgressStage stage;
  double share = 1.0;
};

struct JobProgress {
  QString stage, part;                          // ProgressStage's name and part
  double stage_fraction = 0.0, fraction = 0.0;  // 0..1, never falling
  double elapsed_s = 0.0;
  double remaining_s = -1.0;  // negative: not yet known
};

struct LogLine {
  LogLevel level = LogLevel::Info;
  double time_s = 0.0;  // since the job's start
  QString text;
};

class JobRunner : public QObject {
  Q_OBJECT

 public:
  using Work = std::function<void(const RunContext&)>;

  explicit JobRunner(QObject* parent = nullptr);
  ~JobRunner() override;  // requests a stop and waits; emits no further signals

  bool running() const { return running_; }
  bool cancelling() const { return running_ && stop_.stop_requested(); }
  QString title() const { return title_; }
  QString logText() const;  // of the running or last job, like log.txt

  // False, without effect, while another job runs.
  bool start(const QString& title, std::vector<JobStage> stages, Work work);
  void cancel();

 signals:
  void started(const QString& title);
  void stageStarted(const QString& stage);
  void progressed(const evical::ui::JobProgress& progress);
  void logged(const evical::ui::LogLine& line);
  void ticked();  // while running, and once before finished: poll the mailboxes
  void failed(const evical::ui::JobError& error);
  void finished(evical::ui::JobOutcome outcome);  // last signal; running() is false

 private:
  struct Reports;

  void tick();
  void finish();

  std::shared_ptr<Reports> reports_;
  QTimer timer_;
  QString title_;
  std::stop_source stop_;
  std::jthread thread_;
  bool running_ = false;
};

}  // namespace evical::ui

Q_DECLARE_METATYPE(evical::ui::JobError)
Q_DECLARE_METATYPE(evical::ui::JobOutcome)
Q_DECLARE_METATYPE(evical::ui::JobProgress)
Q_DECLARE_METATYPE(evical::ui::LogLine)
