// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/linked_pages.h"

#include "ui/window/pages.h"
#include "ui/window/workbench.h"

#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/rig/detected_recording.h"
#include "ui/detection/detection_engine.h"
#include "ui/detection/detection_screen.h"
#include "ui/plots/convergence_screen.h"
#include "ui/plots/residuals_screen.h"
#include "ui/plots/signals_screen.h"
#include "ui/scene/trajectory_screen.h"
#include "ui/screens/recording/check_card.h"
#include "ui/screens/recording/recording_screen.h"
#include "ui/screens/result/result_screen.h"
#include "ui/theme/theme.h"

#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include <algorithm>

namespace evical::ui {
namespace {

// The pages show the existing parts of a run from a damaged folder; null if their part is missing.
std::shared_ptr<const CalibrationRun> withTrajectory(const std::shared_ptr<const CalibrationRun>& run) {
  return run && !run->result.state.world_from_imu_rotation.control_points.empty() ? run : nullptr;
}
std::shared_ptr<const CalibrationRun> withResiduals(const std::shared_ptr<const CalibrationRun>& run) {
  return run && !run->result.circle_residuals.empty() ? run : nullptr;
}
std::shared_ptr<const CalibrationRun> withSamples(const std::shared_ptr<const CalibrationRun>& run) {
  return run && run->detections.imus.size() == run->result.state.imus.size() ? withTrajectory(run) : nullptr;
}

// Detections of the last run for the present session, to calibrate without some windows.
std::optional<DetectedRecording> lastDetectedFor(const Session& session, const RunRecord& last) {
  if (!last.run || last.run->detections.cameras.size() != session.cameras.size() ||
      last.run->detections.imus.size() != session.imus.size() || !detectsTheSame(last.session, session))
    return std::nullopt;
  return forSession({last.run->detections, last.run->intrinsics}, session);
}

void wireRejections(DetectionScreen& screen, Workbench& workbench) {
  CalibrationDocument& document = workbench.document;
  const LensDocument& lens = workbench.lens;
  const auto show = [&screen, &document, &lens] {
    const bool of_rig = lens.aim() == CalibrationAim::Rig && document.last().run;
    screen.setRejections(of_rig ? std::optional(document.rejections()) : std::nullopt);
  };
  QObject::connect(&document, &CalibrationDocument::sessionChanged, &screen, show);
  QObject::connect(&document, &CalibrationDocument::runsChanged, &screen, show);
  QObject::connect(&lens, &LensDocument::aimChanged, &screen, show);
  QObject::connect(&screen, &DetectionScreen::rejectionsWanted, &document,
                   &CalibrationDocument::setRejections);
  QObject::connect(&workbench.runner, &JobRunner::started, &screen, [&screen] { screen.setBusy(true); });
  QObject::connect(&workbench.runner, &JobRunner::finished, &screen, [&screen] { screen.setBusy(false); });
}

void wireDetection(DetectionScreen& screen, Workbench& workbench) {
  CalibrationDocument& document = workbench.document;
  CalibrationJob& job = workbench.calibration;
  wireRejections(screen, workbench);
  QObject::connect(&document, &CalibrationDocument::sessionChanged, &screen, [&screen, &document] {
    if (document.hasSession()) screen.setSession(document.session());
  });
  QObject::connect(&document, &CalibrationDocument::runsChanged, &screen,
                   [&screen, &document] { screen.setRun(document.last().run, document.last().session); });
  job.observeWith([&screen] { return screen.liveObserver(); });
  QObject::connect(&job, &CalibrationJob::detecting, &screen, [&screen] { screen.setLive(true); });
  QObject::connect(&job, &CalibrationJob::detectionDone, &screen, [&screen] { screen.setLive(false); });
  QObject::connect(&job, &CalibrationJob::ended, &screen, [&screen] { screen.setLive(false); });
}

std::vector<std::optional<CameraIntrinsics>> intrinsicsOf(const Session& session) {
  std::vector<std::optional<CameraIntrinsics>> all;
  for (const CameraLens& lens : givenLenses(session)) all.push_back(lens.given);
  return all;
}

void wireTrajectory(TrajectoryScreen& screen, Workbench& workbench) {
  const CalibrationDocument& document = workbench.document;
  const CalibrationJob& job = workbench.calibration;
  const auto show_session = [&screen, &document] {
    screen.setBoards(document.session());
    screen.setIntrinsics(intrinsicsOf(document.session()));
  };
  QObject::connect(&document, &CalibrationDocument::runsChanged, &screen, [&screen, &document, show_session] {
    if (const auto run = withTrajectory(document.last().run))
      return screen.setRun(run, document.last().session);
    screen.clear();
    show_session();
  });
  QObject::connect(&document, &CalibrationDocument::sessionReplaced, &screen, show_session);
  QObject::connect(&job, &CalibrationJob::detecting, &screen, [&screen, show_session] {
    screen.clear();
    show_session();
  });
  QObject::connect(&job, &CalibrationJob::detectionsChanged, &screen,
                   [&screen, &document](const std::shared_ptr<const LiveDetections>& cameras) {
                     const auto intrinsics = intrinsicsOf(document.session());
                     for (std::size_t k = 0; k < std::min(cameras->size(), intrinsics.size()); ++k)
                       if (intrinsics[k]) screen.setDetections((*cameras)[k].views, *intrinsics[k], k);
                   });
  QObject::connect(&job, &CalibrationJob::iterationsChanged, &screen,
                   [&screen](const std::shared_ptr<const LiveIterations>& iterations) {
                     screen.setState({iterations, &iterations->state});
                   });
}

NeededAccuracy neededBy(const Session& session) {
  const OptimisationOptions& options = *session.options.optimisation;
  return {options.needed_rotation_deg, options.needed_translation_mm, options.needed_time_offset_ms};
}

void wireConvergence(ConvergenceScreen& screen, Workbench& workbench) {
  const CalibrationDocument& document = workbench.document;
  const CalibrationJob& job = workbench.calibration;
  const auto shown = std::make_shared<std::size_t>(0);
  const auto start_anew = [&screen, &document, shown] {
    *shown = 0;
    screen.clear();
    screen.setNeeded(neededBy(document.session()));
  };
  QObject::connect(&job, &CalibrationJob::started, &screen, start_anew);
  QObject::connect(&job, &CalibrationJob::iterationsChanged, &screen,
                   [&screen, shown](const std::shared_ptr<const LiveIterations>& iterations) {
                     for (; *shown < iterations->records.size(); ++*shown)
                       screen.appendIteration(iterations->records[*shown]);
                   });
  QObject::connect(&document, &CalibrationDocument::runsChanged, &screen, [&screen, &document] {
    screen.setRun(document.last().run);
    if (document.last().run) screen.setNeeded(neededBy(document.last().session));
  });
}

void wireResiduals(ResidualsScreen& screen, Workbench& workbench) {
  const CalibrationDocument& document = workbench.document;
  QObject::connect(&document, &CalibrationDocument::runsChanged, &screen,
                   [&screen, &document] { screen.setRun(withResiduals(document.last().run)); });
  QObject::connect(
      &screen, &ResidualsScreen::recalibrateWithout, &screen,
      [&screen, &workbench](const std::vector<int>& views) {
        const auto run = workbench.document.last().run;
        if (!run) return;
        const auto camera = static_cast<std::size_t>(screen.camera());
        RejectedTimes rejections = workbench.document.rejections();
        std::vector<double>& times_s = rejections.at(camera);
        for (const int view : views)
          times_s.push_back(run->detections.cameras[camera].views.at(static_cast<std::size_t>(view)).time_s);
        std::sort(times_s.begin(), times_s.end());
        workbench.document.setRejections(rejections, QObject::tr("Reject event windows"));
        calibrateRig(workbench);
      });
}

// Pages show "press Calibrate" only if that is possible.
template <class... Screen>
void followRuns(const CalibrationJob& job, Screen*... screen) {
  (QObject::connect(&job, &CalibrationJob::started, screen, [screen] { screen->setCalibrating(true); }), ...);
  (QObject::connect(&job, &CalibrationJob::ended, screen, [screen] { screen->setCalibrating(false); }), ...);
}

// Detection has already read the recording.
EventLookup eventsOf(const DetectionScreen& detection) {
  const std::optional<KeptEvents> kept = detection.keptEvents();
  if (!kept) return {};
  return {kept->camera,
          [events = *kept](double begin_s, double end_s) { return events.between(begin_s, end_s); }};
}

// One cursor: a time chosen on one screen is shown on the others.
template <class From, class... To>
void linkTime(From* from, To*... to) {
  (QObject::connect(from, &From::timeSelected, to, &To::setTime), ...);
}

}  // namespace

void calibrateRig(Workbench& workbench) {
  const CalibrationDocument& document = workbench.document;
  const Session& session = document.session();
  const RunRecord& last = document.last();
  std::optional<DetectedRecording> detected;
  if (document.rejectionsArePending()) detected = lastDetectedFor(session, last);
  if (detected) {
    workbench.calibration.startAgain(session, withRejected(detected->detections, document.rejections()),
                                     std::move(detected->intrinsics));
    return;
  }
  detected = workbench.check.detectedFor(session);
  if (!detected) {
    workbench.calibration.start(session);
    return;
  }
  workbench.calibration.startAgain(session, std::move(detected->detections), std::move(detected->intrinsics));
}

void wireLinkedPages(const Pages& pages, Workbench& workbench) {
  wireDetection(*pages.detection, workbench);
  wireTrajectory(*pages.trajectory, workbench);
  pages.trajectory->setEventSource([pages] { return eventsOf(*pages.detection); });
  wireConvergence(*pages.convergence, workbench);
  wireResiduals(*pages.residuals, workbench);
  const CalibrationDocument& document = workbench.document;
  QObject::connect(&document, &CalibrationDocument::runsChanged, pages.signal_curves, [pages, &document] {
    pages.signal_curves->setRun(withSamples(document.last().run), document.last().session);
  });
  QObject::connect(&workbench.check, &RecordingCheckJob::checkedAnew, pages.detection,
                   [pages](const std::shared_ptr<const CheckedRecording>& checked) {
                     if (checked->detected)
                       pages.detection->goWhereSeen(checked->detected->detections.cameras);
                   });
  followRuns(workbench.calibration, pages.result, pages.signal_curves, pages.residuals);
  // The detection screen may have followed the run.
  QObject::connect(&workbench.calibration, &CalibrationJob::ended, pages.trajectory, [pages] {
    const double time_s = pages.detection->time_s();
    pages.trajectory->setTime(time_s);
    pages.signal_curves->setTime(time_s);
    pages.residuals->setTime(time_s);
  });
  linkTime(pages.detection, pages.trajectory, pages.signal_curves, pages.residuals);
  linkTime(pages.trajectory, pages.detection, pages.signal_curves, pages.residuals);
  linkTime(pages.signal_curves, pages.detection, pages.trajectory, pages.residuals);
  linkTime(pages.residuals, pages.detection, pages.trajectory, pages.signal_curves);
}

}  // namespace evical::ui

namespace evical::ui {
namespace {

using Files = std::vector<std::filesystem::path>;

// The session's recording first.
Files filesOf(const Session& session) {
  Files files;
  const auto add = [&](const std::filesystem::path& file) {
    if (!file.empty() && std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  };
  add(session.recording);
  for (const SessionCamera& camera : session.cameras) add(camera.recording);
  for (const SessionImu& imu : session.imus) {
    add(imu.recording);
    add(imu.accelerometer_recording);
  }
  return files;
}

// The recording is complete: streams, rates and pictures are read again.
void readAnew(const Pages& pages, Workbench& workbench) {
  QStringList recordings;
  for (const std::filesystem::path& file : filesOf(workbench.document.session()))
    recordings << QString::fromStdString(file.string());
  workbench.inspection.start(recordings);
  pages.detection->readAgain();
}

}  // namespace

void wireFollowing(const Pages& pages, Workbench& workbench) {
  GrowingRecording& growing = workbench.growing;
  RecordingCheckJob& check = workbench.check;
  const CalibrationDocument& document = workbench.document;
  RecordingScreen& screen = *pages.recording;
  CheckCard& card = *screen.checkCard();
  QObject::connect(&document, &CalibrationDocument::sessionChanged, &growing,
                   [&growing, &document, &card, &screen] {
                     growing.setFiles(document.hasSession() ? filesOf(document.session()) : Files{});
                     card.offerFollowing(growing.grown() || growing.following());
                     screen.setBeingWritten(growing.grown() || growing.following());
                   });
  QObject::connect(&growing, &GrowingRecording::growthNoticed, &card, [&card, &screen] {
    card.offerFollowing(true);
    screen.setBeingWritten(true);
  });
  QObject::connect(&card, &CheckCard::followingWanted, &growing, &GrowingRecording::setFollowing);
  // The summary has another wording while following.
  QObject::connect(&growing, &GrowingRecording::followingChanged, &card, [&card, &check](bool following) {
    card.setFollowing(following);
    if (const auto& checked = check.checked()) card.setAssessment(checked->assessment);
  });
  QObject::connect(&growing, &GrowingRecording::lookWanted, &check, &RecordingCheckJob::lookAgain);
  QObject::connect(&check, &RecordingCheckJob::started, &growing, &GrowingRecording::lookBegan);
  for (const auto ended : {&RecordingCheckJob::outdated, &RecordingCheckJob::interrupted})
    QObject::connect(&check, ended, &growing, &GrowingRecording::lookEnded);
  QObject::connect(&check, &RecordingCheckJob::checkedAnew, &growing, &GrowingRecording::lookEnded);
  QObject::connect(&check, &RecordingCheckJob::failed, &growing, &GrowingRecording::lookEnded);
  QObject::connect(&growing, &GrowingRecording::endReached, &screen, [pages, &workbench, &card, &screen] {
    card.offerFollowing(false);
    screen.setBeingWritten(false);
    readAnew(pages, workbench);
  });
}

RigPage::RigPage(QWidget* page, const QString& what, QWidget* parent) : QStackedWidget(parent) {
  auto* const note = new QWidget(this);
  auto* const layout = new QVBoxLayout(note);
  auto* const text = new QLabel(tr("%1 to the calibration of a rig: a camera and an IMU, or several cameras. "
                                   "The result of a camera alone is on the page Result.")
                                    .arg(what),
                                note);
  text->setProperty("role", "heading");
  text->setWordWrap(true);
  text->setAlignment(Qt::AlignCenter);
  auto* const rig = new QPushButton(icon("axes"), tr("Calibrate the rig instead"), note);
  rig->setToolTip(tr("Choose the calibration of the rig; it is not started yet"));
  connect(rig, &QPushButton::clicked, this, &RigPage::rigRequested);
  layout->addStretch();
  layout->addWidget(text);
  layout->addWidget(rig, 0, Qt::AlignHCenter);
  layout->addStretch();
  addWidget(page);
  addWidget(note);
}

void RigPage::setAim(CalibrationAim aim) {
  setCurrentIndex(aim == CalibrationAim::Rig ? 0 : 1);
}

}  // namespace evical::ui
