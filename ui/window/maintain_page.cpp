// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/maintain_page.h"

#include "core/base/error.h"
#include "core/pipeline/maintain/maintain_files.h"
#include "ui/plots/maintenance_charts.h"
#include "ui/screens/assessment/file_list.h"
#include "ui/screens/assessment/maintain_screen.h"
#include "ui/screens/assessment/old_result_row.h"
#include "ui/screens/assessment/work_bar.h"
#include "ui/window/old_result.h"
#include "ui/window/page_work.h"
#include "ui/window/session_files.h"
#include "ui/window/workbench.h"

#include <QFileDialog>

#include <memory>

namespace evical::ui {
namespace {

using Maintained = std::shared_ptr<const MaintainedLogs>;

void startMaintain(MaintainScreen& screen, Workbench& workbench, SessionFiles& files) {
  std::vector<std::filesystem::path> logs;
  for (const QString& log : screen.logs().files()) logs.emplace_back(log.toStdString());
  try {
    const auto read = [logs, result = screen.result().path().toStdString(), settings = screen.settings(),
                       options = workbench.document.session().options.maintain,
                       trajectory = screen.trajectory().path().toStdString()] {
      MaintainInput input = readMaintainInput(logs, result);
      input.settings = settings;
      input.options = options;
      input.trajectory = trajectory;
      return input;
    };
    workbench.maintain.start(read, workbench.version);
  } catch (const CalibrationError& error) {
    emit files.failed(QObject::tr("These logs cannot be looked at"), errorOf(error));
  }
}

void chooseFilesMaintain(MaintainScreen& screen) {
  QObject::connect(&screen.logs(), &FileList::addRequested, &screen, [&screen] {
    screen.logs().add(QFileDialog::getOpenFileNames(&screen, QObject::tr("Logs of the IMUs"),
                                                    lastUsedFolder(), recordingsFilter(false)));
  });
  QObject::connect(&screen.trajectory(), &PathRow::chooseRequested, &screen, [&screen] {
    const QString file = QFileDialog::getOpenFileName(
        &screen, QObject::tr("Trajectory of the reference IMU"), lastUsedFolder(),
        QObject::tr("Trajectories (*.csv *.txt *.tum);;All files (*)"));
    if (!file.isEmpty()) screen.trajectory().setPath(file);
  });
}

void saveMaintain(MaintainScreen& screen, const Maintained& maintained, Workbench& workbench,
                  SessionFiles& files) {
  const auto write = [maintained](const std::filesystem::path& folder) {
    writeMaintenanceFiles(folder, maintained->maintenance, maintained->log.toStdString());
  };
  saveToFolder(screen,
               {QObject::tr("Save what was found"), QObject::tr("What was found of the IMUs was saved")},
               write, workbench, files);
}

}  // namespace

void wireMaintain(MaintainScreen& screen, MaintenanceCharts& charts, Workbench& workbench,
                  SessionFiles& files) {
  MaintainJob& job = workbench.maintain;
  chooseFilesMaintain(screen);
  wireOldResult(screen.result(), screen, workbench);
  wireWork(screen.work(), workbench.runner, [&job] { return job.running(); });
  QObject::connect(&screen, &MaintainScreen::maintainRequested, &screen,
                   [&screen, &workbench, &files] { startMaintain(screen, workbench, files); });
  QObject::connect(&screen, &MaintainScreen::cancelRequested, &workbench.runner, &JobRunner::cancel);
  const auto kept = std::make_shared<Maintained>();
  QObject::connect(&job, &MaintainJob::maintained, &screen,
                   [&screen, &charts, kept](const Maintained& maintained) {
                     *kept = maintained;
                     screen.setMaintenance(maintained->maintenance);
                     charts.setMaintenance(maintained->maintenance);
                   });
  QObject::connect(&screen, &MaintainScreen::saveRequested, &screen, [&screen, kept, &workbench, &files] {
    if (*kept) saveMaintain(screen, *kept, workbench, files);
  });
}

}  // namespace evical::ui
