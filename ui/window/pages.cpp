// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/pages.h"

#include "core/export/export_target.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/pipeline/runs/result_files.h"
#include "ui/detection/detection_screen.h"
#include "ui/plots/convergence_screen.h"
#include "ui/plots/maintenance_charts.h"
#include "ui/plots/residuals_screen.h"
#include "ui/plots/signals_screen.h"
#include "ui/scene/trajectory_screen.h"
#include "ui/screens/assessment/maintain_screen.h"
#include "ui/screens/assessment/repeat_screen.h"
#include "ui/screens/assessment/result_check_screen.h"
#include "ui/screens/lens/lens_screen.h"
#include "ui/screens/recording/aim_chooser.h"
#include "ui/screens/recording/recording_screen.h"
#include "ui/screens/recording/start_screen.h"
#include "ui/screens/result/result_screen.h"
#include "ui/window/assessment_pages.h"
#include "ui/window/lens_files.h"
#include "ui/window/linked_pages.h"
#include "ui/window/print_board.h"
#include "ui/window/recent_files.h"
#include "ui/window/recording_check.h"
#include "ui/window/session_files.h"
#include "ui/window/workbench.h"

#include <QStackedWidget>

#include <optional>
#include <vector>

namespace evical::ui {
namespace {

void wireStart(StartScreen& start, Workbench& workbench, SessionFiles& files) {
  start.setRecentFiles(recentFiles());
  QObject::connect(&start, &StartScreen::openRecordingRequested, &files, &SessionFiles::chooseRecording);
  QObject::connect(&start, &StartScreen::openSessionRequested, &files, &SessionFiles::chooseSession);
  QObject::connect(&start, &StartScreen::printBoardRequested, &start,
                   [&start, &workbench] { showPrintBoard(start.window(), workbench); });
  QObject::connect(&start, &StartScreen::howToRecordRequested, &start,
                   [&start] { showHowToRecord(start.window()); });
  QObject::connect(&start, &StartScreen::demoRequested, &files, [&workbench, &files] {
    if (workbench.runner.running()) return;
    workbench.lens.setAim(CalibrationAim::Rig);  // the demo is a rig
    files.openDemo();
  });
  QObject::connect(&start, &StartScreen::fileChosen, &files, &SessionFiles::openRecent);
  QObject::connect(&files, &SessionFiles::recentFilesChanged, &start,
                   [&start] { start.setRecentFiles(recentFiles()); });
  QObject::connect(&files, &SessionFiles::demoRunning, &start, &StartScreen::setDemoRunning);
  QObject::connect(&workbench.runner, &JobRunner::progressed, &start,
                   [&start](const JobProgress& progress) { start.setDemoProgress(progress.fraction); });
}

void wireRecording(RecordingScreen& screen, Workbench& workbench, SessionFiles& files) {
  CalibrationDocument& document = workbench.document;
  QObject::connect(&screen, &RecordingScreen::openRecordingRequested, &files, &SessionFiles::chooseRecording);
  QObject::connect(&screen, &RecordingScreen::sessionEdited, &document, &CalibrationDocument::edit);
  const LensDocument& lens = workbench.lens;
  const auto show_problems = [&screen, &lens] {
    const bool camera_only = lens.offersCameraOnly();
    std::vector<std::pair<QString, QString>> problems;
    for (const SessionProblem& problem : camera_only ? lens.problemsOfCamera() : lens.problems())
      problems.emplace_back(problem.field, problem.text);
    screen.setProblems(problems);
    screen.offerCameraOnly(camera_only);
  };
  QObject::connect(&document, &CalibrationDocument::sessionChanged, &screen,
                   [&screen, &document, show_problems] {
                     screen.setSession(document.session());
                     show_problems();
                   });
  QObject::connect(&lens, &LensDocument::aimChanged, &screen, show_problems);
  QObject::connect(&document, &CalibrationDocument::runsChanged, &screen, [&screen, &document] {
    std::vector<std::optional<CameraIntrinsics>> found;
    if (const auto run = document.last().run)
      for (const CameraState& camera : run->result.state.cameras) found.push_back(camera.lens.found());
    screen.setFoundIntrinsics(found);
  });
  const InspectionJob& inspection = workbench.inspection;
  QObject::connect(&screen, &RecordingScreen::addRecordingRequested, &files,
                   &SessionFiles::chooseFurtherRecording);
  QObject::connect(&inspection, &InspectionJob::restarted, &screen, &RecordingScreen::clearInspections);
  QObject::connect(&inspection, &InspectionJob::started, &screen, &RecordingScreen::setInspecting);
  QObject::connect(&inspection, &InspectionJob::progressed, &screen, &RecordingScreen::setInspectionProgress);
  QObject::connect(&inspection, &InspectionJob::inspected, &screen, &RecordingScreen::addInspection);
  QObject::connect(
      &inspection, &InspectionJob::failed, &screen,
      [&screen](const QString&, const JobError& error) { screen.setInspectionFailed(error.text()); });
}

std::optional<NamedResult> namedRecord(const RunRecord& record, const QString& version) {
  if (!record.run) return std::nullopt;
  return namedResult(record.session, resultOf(record.run), version.toStdString());
}

void wireResult(ResultScreen& screen, Workbench& workbench, SessionFiles& files) {
  CalibrationDocument& document = workbench.document;
  QObject::connect(&screen, &ResultScreen::exportRequested, &files, &SessionFiles::chooseExportFolder);
  QObject::connect(&screen, &ResultScreen::reportRequested, &files, &SessionFiles::openReport);
  QObject::connect(&screen, &ResultScreen::referenceRequested, &files, &SessionFiles::chooseReference);
  const auto fill = [&screen, &workbench] {
    screen.setRuns(namedRecord(workbench.document.previous(), workbench.version),
                   namedRecord(workbench.document.last(), workbench.version));
    screen.setOutdated(workbench.document.runIsOutdated());
  };
  // Delayed by a turn: it takes as long as all other updates at a calibration's end together.
  QObject::connect(&document, &CalibrationDocument::runsChanged, &screen,
                   [&screen, fill] { afterTurns(1, &screen, fill); });
  QObject::connect(&document, &CalibrationDocument::sessionChanged, &screen,
                   [&screen, &document] { screen.setOutdated(document.runIsOutdated()); });
  QObject::connect(&document, &CalibrationDocument::referenceChanged, &screen, [&screen, &document] {
    if (!document.reference()) return screen.setReference(std::nullopt, {});
    screen.setReference(document.reference()->named, document.reference()->title);
  });
}

}  // namespace

QKeySequence keyOfPage(std::size_t index) {
  constexpr std::size_t kDigits = 10;
  const QString keys = index < kDigits ? "Ctrl+%1" : "Ctrl+Shift+%1";
  return QKeySequence(keys.arg((index + 1) % kDigits));
}

std::vector<PageEntry> buildPages(Pages& pages, QWidget* parent) {
  pages.start = new StartScreen(parent);
  pages.recording = new RecordingScreen(parent);
  pages.detection = new DetectionScreen(parent);
  pages.trajectory = new TrajectoryScreen(parent);
  pages.convergence = new ConvergenceScreen(parent);
  pages.signal_curves = new SignalsScreen(parent);
  pages.residuals = new ResidualsScreen(parent);
  pages.result = new ResultScreen(parent);
  pages.lens = new LensScreen(parent);
  pages.result_check = new ResultCheckScreen(parent);
  pages.repeat = new RepeatScreen(parent);
  pages.maintenance_charts = new MaintenanceCharts(parent);
  pages.maintain = new MaintainScreen(pages.maintenance_charts, parent);
  pages.results = new QStackedWidget(parent);
  pages.results->addWidget(pages.result);
  pages.results->addWidget(pages.lens);
  const auto of_rig = [&](QWidget* page, const QString& what) {
    pages.of_rigs.push_back(new RigPage(page, what, parent));
    return pages.of_rigs.back();
  };
  constexpr PageGroup kThis = PageGroup::ThisRecording, kMore = PageGroup::More;
  const auto tr = [](const char* text) { return QObject::tr(text); };
  return {{"start", tr("Start"), "home", pages.start},
          {"recording", tr("Recording"), "recording", pages.recording, kThis, PageNeed::Session},
          {"detection", tr("Detection"), "detection", pages.detection, kThis, PageNeed::Session},
          {"trajectory", tr("Trajectory"), "trajectory", of_rig(pages.trajectory, tr("Trajectories belong")),
           kThis, PageNeed::RunOfRig},
          {"convergence", tr("Convergence"), "convergence",
           of_rig(pages.convergence, tr("Convergence belongs")), kThis, PageNeed::RunOfRig},
          {"signals", tr("Signals"), "signals", of_rig(pages.signal_curves, tr("Signals belong")), kThis,
           PageNeed::RunOfRig},
          {"residuals", tr("Residuals"), "residuals", of_rig(pages.residuals, tr("Residuals belong")), kThis,
           PageNeed::RunOfRig},
          {"result", tr("Result"), "result", pages.results, kThis, PageNeed::Run},
          {"check-result", tr("Check a result"), "check", pages.result_check, kMore},
          {"repeat", tr("Several recordings"), "compare", pages.repeat, kMore},
          {"maintain", tr("IMUs over time"), "imu", pages.maintain, kMore}};
}

void wirePages(const Pages& pages, Workbench& workbench, SessionFiles& files, LensFiles& lens_files) {
  wireStart(*pages.start, workbench, files);
  wireRecording(*pages.recording, workbench, files);
  wireRecordingCheck(*pages.recording, workbench);
  wireFollowing(pages, workbench);
  wireResult(*pages.result, workbench, files);
  QObject::connect(pages.detection, &DetectionScreen::recordingWanted, &files,
                   &SessionFiles::lookForRecording);
  wireLinkedPages(pages, workbench);
  wireLensPages(pages, workbench, lens_files);
  wireResultCheck(*pages.result_check, workbench, files);
  wireRepeat(*pages.repeat, workbench, files);
  wireMaintain(*pages.maintain, *pages.maintenance_charts, workbench, files);
}

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
