// SPDX-License-Identifier: GPL-3.0-or-later
// `evical check`, `evical maintain` and `evical repeat` as jobs.
#pragma once

#include "core/pipeline/check/check_calibration.h"
#include "core/pipeline/maintain/maintain_imus.h"
#include "core/pipeline/repeat/repeat_calibration.h"
#include "ui/jobs/task_job.h"

namespace evical::ui {

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
