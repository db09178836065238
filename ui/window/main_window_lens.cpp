// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of the window for the calibration of a camera alone.
#include "ui/screens/lens/lens_screen.h"
#include "ui/screens/recording/recording_screen.h"
#include "ui/window/lens_files.h"
#include "ui/window/log_panel.h"
#include "ui/window/main_window.h"
#include "ui/window/session_files.h"
#include "ui/window/steps_panel.h"

namespace evical::ui {

void MainWindow::wireLens() {
  LensDocument& lens = workbench_.lens;
  IntrinsicsJob& job = workbench_.intrinsics;
  connect(&lens, &LensDocument::aimChanged, this, [this] {
    steps_->setAim(workbench_.lens.aim());
    showState();
  });
  connect(&lens, &LensDocument::runChanged, this, &MainWindow::showState);
  connect(lens_files_, &LensFiles::failed, this, &MainWindow::showProblem);
  connect(lens_files_, &LensFiles::saved, this, [this](const QString& path) {
    log_->add({LogLevel::Info, 0.0, tr("The lens was saved to %1").arg(path)});
  });
  connect(pages_.lens, &LensScreen::calibrateRequested, this, &MainWindow::calibrate);
  connect(pages_.recording, &RecordingScreen::cameraOnlyRequested, this, [this] {
    if (workbench_.runner.running()) return;
    workbench_.lens.setAim(CalibrationAim::Camera);
    calibrate();
  });
  connect(&job, &IntrinsicsJob::detectionsChanged, steps_,
          [this](const std::shared_ptr<const LiveDetections>& live) { steps_->setDetections(*live); });
  connect(&job, &IntrinsicsJob::passDone, steps_, &StepsPanel::setPass);
  connect(&job, &IntrinsicsJob::calibrated, this,
          [this](const FoundLens& found, const Session& session, std::size_t camera, const QString& log) {
            paintPagesLater();
            workbench_.lens.addRun({found.run, found.seen, session, camera, log});
            showResultSoon();
          });
}

// Exports all files to a folder.
void MainWindow::exportResult() {
  if (workbench_.lens.aim() == CalibrationAim::Camera) return lens_files_->chooseFolder();
  files_->chooseExportFolder();
}

}  // namespace evical::ui
