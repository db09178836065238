// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/pages.h"
#include "ui/window/assessment_pages.h"

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
#include "ui/screens/recording/recording_screen.h"
#include "ui/screens/recording/start_screen.h"
#include "ui/screens/result/result_screen.h"
#include "ui/window/after_turns.h"
#include "ui/window/follow_recording.h"
#include "ui/window/lens_pages.h"
#include "ui/window/linked_pages.h"
#include "ui/window/print_board.h"
#include "ui/window/recent_files.h"
#include "ui/window/recording_check.h"
#include "ui/window/rig_page.h"
#include "ui/window/session_files.h"
#include "ui/window/workbench.h"

#include <QStackedWidget>

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

}  // namespace evical::ui
