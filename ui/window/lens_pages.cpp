// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/lens_pages.h"

#include "core/export/export_target.h"
#include "core/geometry/camera_intrinsics.h"
#include "ui/detection/detection_screen.h"
#include "ui/screens/lens/lens_screen.h"
#include "ui/screens/recording/aim_chooser.h"
#include "ui/screens/recording/recording_screen.h"
#include "ui/screens/recording/start_screen.h"
#include "ui/window/after_turns.h"
#include "ui/window/lens_files.h"
#include "ui/window/pages.h"
#include "ui/window/rig_page.h"
#include "ui/window/workbench.h"

#include <QStackedWidget>

#include <optional>
#include <vector>

namespace evical::ui {
namespace {

QStringList cameraNames(const Session& session) {
  QStringList names;
  for (const SessionCamera& camera : session.cameras) names << QString::fromStdString(camera.name);
  return names;
}

// A running job keeps its aim.
void wireAim(AimChooser& chooser, Workbench& workbench) {
  LensDocument& lens = workbench.lens;
  JobRunner& runner = workbench.runner;
  QObject::connect(&runner, &JobRunner::started, &chooser, [&chooser] { chooser.setEnabled(false); });
  QObject::connect(&runner, &JobRunner::finished, &chooser, [&chooser] { chooser.setEnabled(true); });
  const auto show = [&chooser, &workbench] {
    chooser.setAim(workbench.lens.aim());
    chooser.setCameras(cameraNames(workbench.document.session()), static_cast<int>(workbench.lens.camera()));
  };
  QObject::connect(&chooser, &AimChooser::aimChosen, &lens, &LensDocument::setAim);
  QObject::connect(&chooser, &AimChooser::cameraChosen, &lens, &LensDocument::setCamera);
  QObject::connect(&lens, &LensDocument::aimChanged, &chooser, show);
  QObject::connect(&workbench.document, &CalibrationDocument::sessionChanged, &chooser, show);
}

void wireRigPages(const Pages& pages, Workbench& workbench) {
  LensDocument& lens = workbench.lens;
  for (RigPage* const page : pages.of_rigs) {
    QObject::connect(&lens, &LensDocument::aimChanged, page, [page, &lens] { page->setAim(lens.aim()); });
    QObject::connect(page, &RigPage::rigRequested, &lens, [&workbench] {
      if (!workbench.runner.running()) workbench.lens.setAim(CalibrationAim::Rig);
    });
  }
  QObject::connect(&lens, &LensDocument::aimChanged, pages.results, [pages, &lens] {
    pages.results->setCurrentIndex(lens.aim() == CalibrationAim::Camera ? 1 : 0);
  });
}

void wireLensRecording(RecordingScreen& screen, Workbench& workbench) {
  LensDocument& lens = workbench.lens;
  QObject::connect(&lens, &LensDocument::runChanged, &screen, [&screen, &lens] {
    if (!lens.last().run) return;
    std::vector<std::optional<CameraIntrinsics>> found(lens.last().session.cameras.size());
    found.at(lens.last().camera) = lens.last().run->result.intrinsics;
    screen.setFoundIntrinsics(found);
  });
}

// Shows the run of the current aim on Detection: of the rig, or of a camera alone.
void wireLensDetection(DetectionScreen& screen, Workbench& workbench) {
  IntrinsicsJob& job = workbench.intrinsics;
  LensDocument& lens = workbench.lens;
  const CalibrationDocument& document = workbench.document;
  const auto show = [&screen, &lens, &document] {
    if (lens.aim() == CalibrationAim::Camera) return screen.setRun(lens.last().seen, lens.last().session);
    screen.setRun(document.last().run, document.last().session);
  };
  QObject::connect(&lens, &LensDocument::runChanged, &screen, show);
  QObject::connect(&lens, &LensDocument::aimChanged, &screen, show);
  job.observeWith([&screen] { return screen.liveObserver(); });
  QObject::connect(&job, &IntrinsicsJob::started, &screen, [&screen, &lens] {
    screen.setCamera(lens.camera());
    screen.setLive(true);
  });
  QObject::connect(&job, &IntrinsicsJob::ended, &screen, [&screen] { screen.setLive(false); });
}

// Formats for a camera without a rig; those of ROS and Kalibr are files of the lens.
std::vector<std::pair<QString, QString>> programsForLenses() {
  std::vector<std::pair<QString, QString>> programs;
  for (const char* const name : {"opencv", "metavision", "dv-processing", "ekalibr", "matlab", "numpy"}) {
    const ExportTarget& target = exportTarget(name, {});
    programs.emplace_back(name, QString("%1: %2").arg(target.program, target.files));
  }
  return programs;
}

void wireLens(LensScreen& screen, Workbench& workbench, LensFiles& files) {
  LensDocument& lens = workbench.lens;
  screen.setPrograms(programsForLenses());
  const auto show_others = [&screen, &lens] {
    std::vector<LensScreen::Other> others;
    for (const OtherLens& other : lens.others()) others.emplace_back(other.title, other.lens);
    screen.setOthers(std::move(others));
  };
  const auto fill = [&screen, &workbench, show_others] {
    const LensRecord& last = workbench.lens.last();
    screen.setLens(last.run ? std::optional(namedLens(last, workbench.version)) : std::nullopt);
    show_others();
    screen.setOutdated(workbench.lens.runIsOutdated());
    screen.setInSession(workbench.lens.isInSession());
  };
  QObject::connect(&lens, &LensDocument::runChanged, &screen,
                   [&screen, fill] { afterTurns(1, &screen, fill); });
  QObject::connect(&lens, &LensDocument::othersChanged, &screen, [&screen, &lens, show_others] {
    show_others();
    screen.setOutdated(lens.runIsOutdated());
    screen.setInSession(lens.isInSession());
  });
  QObject::connect(&screen, &LensScreen::useRequested, &lens, &LensDocument::useInSession);
  QObject::connect(&screen, &LensScreen::otherRequested, &files, &LensFiles::chooseOther);
  QObject::connect(&screen, &LensScreen::saveRequested, &files, &LensFiles::chooseFile);
  QObject::connect(&screen, &LensScreen::saveAllRequested, &files, &LensFiles::chooseFolder);
  QObject::connect(&screen, &LensScreen::exportRequested, &files, &LensFiles::chooseFolderFor);
}

}  // namespace

void wireLensPages(const Pages& pages, Workbench& workbench, LensFiles& files) {
  wireAim(pages.recording->aim(), workbench);
  wireRigPages(pages, workbench);
  wireLensRecording(*pages.recording, workbench);
  wireLensDetection(*pages.detection, workbench);
  wireLens(*pages.lens, workbench, files);
}

}  // namespace evical::ui
