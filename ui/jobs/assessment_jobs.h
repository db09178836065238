// SPDX-License-Identifier: GPL-3.0-or-later
// `evical check`, `evical maintain` and `evical repeat` as jobs.
#pragma once

#include "ui/jobs/job_runner.h"

#include "core/pipeline/check/check_calibration.h"
#include "core/pipeline/maintain/maintain_imus.h"
#include "core/pipeline/repeat/repeat_calibration.h"

#include <QObject>

#include <functional>
#include <memory>
#include <utility>
#include <vector>

// Job of a page, whose result is available when it is done.

namespace evical::ui {

class TaskJob : public QObject {
  Q_OBJECT

 public:
  explicit TaskJob(JobRunner& runner, QObject* parent = nullptr);

  bool running() const { return running_; }
  QString log() const { return log_; }  // of the last completed job
  const JobRunner& runner() const { return runner_; }

 signals:
  void done();  // a new result is available

 protected:
  // False, without effect, while the runner is busy. `keep` is called after success.
  bool startWork(const QString& title, std::vector<JobStage> stages, JobRunner::Work work,
                 std::function<void()> keep);

 private:
  void finish(JobOutcome outcome);

  JobRunner& runner_;
  bool running_ = false;
  std::function<void()> keep_;
  QString log_;
};

template <class Found>
class TaskJobOf : public TaskJob {
 public:
  using TaskJob::TaskJob;

  // `work` fills the result, in the job's thread. False while the runner is busy.
  bool start(const QString& title, std::vector<JobStage> stages,
             std::function<void(Found&, const RunContext&)> work) {
    const auto found = std::make_shared<Found>();
    return startWork(
        title, std::move(stages),
        [found, work = std::move(work)](const RunContext& context) { work(*found, context); },
        [this, found] { found_ = found; });
  }
  // Result of the last completed job; empty: none.
  std::shared_ptr<const Found> found() const { return found_; }

 private:
  std::shared_ptr<const Found> found_;
};

// Result with the inputs of its files.
struct CheckedResult {
  CheckInput input;
  CheckRun run;
};

struct RepeatedRecordings {
  RepeatInput input;
  RepeatRun run;
  QString folder;  // folder of its files
};

using ResultCheckJob = TaskJobOf<CheckedResult>;
using MaintainJob = TaskJobOf<Maintenance>;
using RepeatJob = TaskJobOf<RepeatedRecordings>;

// `read` is called in the job's thread. False while the runner is busy.
bool startResultCheck(ResultCheckJob& job, std::function<CheckInput()> read, const QString& version);
bool startMaintain(MaintainJob& job, std::function<MaintainInput()> read, const QString& version);
bool startRepeat(RepeatJob& job, const RepeatInput& input, const QString& folder, const QString& version);

}  // namespace evical::ui
