// SPDX-License-Identifier: GPL-3.0-or-later
// All of the program that is no widget: one document, and the jobs that work for it.
#pragma once

#include "ui/document/calibration_document.h"
#include "ui/document/lens_document.h"
#include "ui/jobs/assessment_jobs.h"
#include "ui/jobs/calibration_job.h"
#include "ui/jobs/growing_recording.h"
#include "ui/jobs/inspection_job.h"
#include "ui/jobs/intrinsics_job.h"
#include "ui/jobs/job_runner.h"
#include "ui/jobs/recording_check_job.h"
#include "ui/jobs/run_history.h"

#include <QString>

namespace evical::ui {

struct Workbench {
  explicit Workbench(QString program_version) : version(std::move(program_version)) {}

  QString version;
  CalibrationDocument document;
  JobRunner runner;
  CalibrationJob calibration{runner};
  RunHistory history;  // has a thread of its own
  LensDocument lens{document};
  IntrinsicsJob intrinsics{runner};  // of one camera's lens alone
  ResultCheckJob result_check{runner};
  RepeatJob repeat{runner};
  MaintainJob maintain{runner};
  InspectionJob inspection;  // has a runner of its own: it may go on beside a calibration
  RecordingCheckJob check;   // so has this one, which gives way to all others
  GrowingRecording growing;  // the session's files, where somebody still writes them
};

}  // namespace evical::ui
