// SPDX-License-Identifier: GPL-3.0-or-later
// The program without widgets: one document, and the jobs that work on it.
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

#include <QObject>
#include <QString>
#include <QTimer>

#include <chrono>
#include <functional>
#include <optional>

namespace evical::ui {

struct Workbench {
  explicit Workbench(QString program_version) : version(std::move(program_version)) {}

  QString version;
  CalibrationDocument document;
  JobRunner runner;
  CalibrationJob calibration{runner};
  RunHistory history;  // has its own thread
  LensDocument lens{document};
  IntrinsicsJob intrinsics{runner};  // for the lens of one camera alone
  ResultCheckJob result_check{runner};
  RepeatJob repeat{runner};
  MaintainJob maintain{runner};
  InspectionJob inspection;  // has its own runner, in parallel to a calibration
  RecordingCheckJob check;   // has its own runner, with lower priority than all others
  GrowingRecording growing;  // the session's files that are still being written

  // Status of the current aim's last run; none before the first run.
  std::optional<CalibrationStatus> lastStatus() const {
    if (const auto& run = lens.last().run; run && lens.aim() == CalibrationAim::Camera)
      return run->result.status;
    if (const auto& run = document.last().run; run && lens.aim() == CalibrationAim::Rig)
      return run->result.status;
    return std::nullopt;
  }
};

// Splits long work over several turns of the event loop, so that no single turn is noticeably long.

// Calls `act` after the given number of turns of the event loop; each turn handles the pending events,
// layouts and paintings.
inline void afterTurns(int turns, QObject* context, const std::function<void()>& act) {
  if (turns <= 0) return act();
  constexpr auto kNext = std::chrono::milliseconds(1);
  QTimer::singleShot(kNext, context, [turns, context, act] { afterTurns(turns - 1, context, act); });
}

}  // namespace evical::ui
