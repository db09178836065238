// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/recording_check.h"

#include "core/pipeline/session/session_guess.h"
#include "ui/screens/recording/check_card.h"
#include "ui/screens/recording/recording_screen.h"
#include "ui/window/print_board.h"
#include "ui/window/workbench.h"

#include <QAction>
#include <QSettings>

#include <memory>
#include <type_traits>

namespace evical::ui {
namespace {

const char* const kKey = "check_recordings";

QString boardText(const Session& session) {
  if (!session.further_boards.empty()) return QObject::tr("%1 boards").arg(session.further_boards.size() + 1);
  if (!session.board.hasPattern()) return QObject::tr("%1 points").arg(session.board.pointCount());
  return QObject::tr("%1 x %2, %3 mm")
      .arg(session.board.rows)
      .arg(session.board.cols)
      .arg(1e3 * session.board.spacing_m);
}

// The session is that of its result.
bool isCalibrated(const Workbench& workbench) {
  const LensDocument& lens = workbench.lens;
  const bool of_camera = lens.aim() == CalibrationAim::Camera;
  return workbench.lastStatus() && !(of_camera ? lens.runIsOutdated() : workbench.document.runIsOutdated());
}

// The card while nothing is checked.
void showIdle(CheckCard& card, const Workbench& workbench) {
  if (isCalibrated(workbench))
    return card.clear(QObject::tr("This recording is calibrated"),
                      QObject::tr("The page Result shows how good the calibration is.\n"
                                  "If you change the session, the recording is checked again."));
  if (!workbench.check.automatic())
    return card.clear({}, QObject::tr("The recording is not checked: the menu Calibrate can enable this."));
  card.clear();
}

// Text in place of "ready" for a session without problems.
void showReadiness(RecordingScreen& screen, const Workbench& workbench, bool failed) {
  const CalibrationDocument& document = workbench.document;
  const bool unconfirmed = document.hasSession() && !document.boardConfirmed();
  CheckCard& card = *screen.checkCard();
  card.setUnconfirmedBoard(unconfirmed ? boardText(document.session()) : QString());
  if (card.isClear()) showIdle(card, workbench);
  const auto& checked = workbench.check.checked();
  if (workbench.growing.following()) return screen.setReservation(QObject::tr("Being recorded"), Light::Fair);
  if (failed || (checked && !checked->assessment.can_be_calibrated))
    return screen.setReservation(QObject::tr("Not ready: see below"), Light::Poor);
  if (workbench.check.awaited()) return screen.setReservation(QObject::tr("Being checked"), Light::Good);
  if (unconfirmed) return screen.setReservation(QObject::tr("The board is not confirmed"), Light::Fair);
  if (isCalibrated(workbench)) return screen.setReservation(QObject::tr("Calibrated"), Light::Good);
  if (checked && checked->assessment.light == Light::Poor)
    return screen.setReservation(QObject::tr("Not good enough: see below"), Light::Fair);
  screen.setReservation({}, checked ? checked->assessment.light : Light::Good);
}

// Session of the current aim: of a single camera, or of the rig.
Session aimedAt(const Workbench& workbench) {
  Session session = workbench.document.session();
  if (workbench.lens.aim() != CalibrationAim::Camera || session.cameras.empty()) return session;
  SessionCamera camera = session.sensor(workbench.lens.camera());
  camera.name = session.cameras[workbench.lens.camera()].name;
  camera.same_sensor_as.clear();
  session.cameras = {std::move(camera)};
  session.imus.clear();
  keepReference(session);
  return session;
}

// Checks a session that is complete and whose recording has been read.
void choose(Workbench& workbench) {
  const Session session = aimedAt(workbench);
  // At the end of a followed recording, it is inspected once more, which changes nothing here.
  const bool inspected = !workbench.inspection.running() || workbench.growing.followedToEnd();
  const bool camera_alone = session.cameras.size() == 1 && session.imus.empty();
  const bool calibrates =
      sessionProblems(session, camera_alone ? CalibrationAim::Camera : CalibrationAim::Rig).empty();
  const bool complete = workbench.document.hasSession() && inspected && !session.board_blinks && calibrates;
  if (!complete) return workbench.check.setSession(std::nullopt);
  // A result is more informative than the check.
  const bool calibrated = workbench.document.last().run && !workbench.document.runIsOutdated();
  if (calibrated && !workbench.check.checked()) return workbench.check.setSession(std::nullopt);
  workbench.check.setSession(session);
}

void wireCard(CheckCard& card, RecordingScreen& screen, Workbench& workbench) {
  const RecordingCheckJob& check = workbench.check;
  const auto ready = [&screen, &workbench] { showReadiness(screen, workbench, false); };
  // Between two checks the card stays: it must not flash at each edit.
  QObject::connect(&check, &RecordingCheckJob::outdated, &card, [&card, &check, &workbench, ready] {
    if (!check.awaited())
      card.clear();
    else if (workbench.runner.running())
      card.setWaiting();
    else
      card.setChecking(0.0);
    ready();
  });
  QObject::connect(&check, &RecordingCheckJob::started, &card, [&card, ready] {
    card.setChecking(0.0);
    ready();
  });
  QObject::connect(&check, &RecordingCheckJob::progressed, &card, &CheckCard::setChecking);
  QObject::connect(&check, &RecordingCheckJob::interrupted, &card, &CheckCard::setWaiting);
  QObject::connect(&check, &RecordingCheckJob::checkedAnew, &card,
                   [&card, ready](const std::shared_ptr<const CheckedRecording>& checked) {
                     card.setAssessment(checked->assessment);
                     ready();
                   });
  QObject::connect(&check, &RecordingCheckJob::failed, &card,
                   [&card, &screen, &workbench](const JobError& error) {
                     card.setFailed(error.text());
                     showReadiness(screen, workbench, true);
                   });
  QObject::connect(&card, &CheckCard::boardConfirmed, &workbench.document,
                   &CalibrationDocument::confirmBoard);
  QObject::connect(&card, &CheckCard::howToRecordRequested, &screen,
                   [&screen] { showHowToRecord(screen.window()); });
  QObject::connect(&workbench.document, &CalibrationDocument::boardConfirmationChanged, &card, ready);
}

}  // namespace

void wireRecordingCheck(RecordingScreen& screen, Workbench& workbench) {
  wireCard(*screen.checkCard(), screen, workbench);
  CalibrationDocument& document = workbench.document;
  RecordingCheckJob& check = workbench.check;
  check.setAutomatic(QSettings().value(kKey, true).toBool());
  const auto anew = [&screen, &workbench] {
    choose(workbench);
    showReadiness(screen, workbench, false);
  };
  QObject::connect(&document, &CalibrationDocument::sessionChanged, &check, anew);
  QObject::connect(&document, &CalibrationDocument::runsChanged, &check, anew);
  QObject::connect(&workbench.growing, &GrowingRecording::followingChanged, &screen,
                   [&screen, &workbench] { showReadiness(screen, workbench, false); });
  QObject::connect(&workbench.lens, &LensDocument::aimChanged, &check, anew);
  QObject::connect(&workbench.lens, &LensDocument::runChanged, &check, anew);
  QObject::connect(&workbench.inspection, &InspectionJob::inspected, &check, anew);
  QObject::connect(&workbench.inspection, &InspectionJob::started, &check, anew);
  QObject::connect(&workbench.runner, &JobRunner::started, &check, [&check] { check.giveWay(true); });
  const auto tell_of = [&screen](const auto& job) {
    using Job = std::decay_t<decltype(job)>;
    QObject::connect(&job, &Job::started, &screen, [&screen] { screen.setCalibrating(true); });
    QObject::connect(&job, &Job::ended, &screen, [&screen] { screen.setCalibrating(false); });
  };
  tell_of(workbench.calibration);
  tell_of(workbench.intrinsics);
  QObject::connect(&workbench.runner, &JobRunner::finished, &check, [&check, &workbench] {
    choose(workbench);
    check.giveWay(false);
  });
}

QAction* makeCheckAction(Workbench& workbench, QObject* parent) {
  auto* const action = new QAction(QObject::tr("Check recordings &automatically"), parent);
  action->setObjectName("check_recordings");
  action->setCheckable(true);
  action->setChecked(workbench.check.automatic());
  action->setToolTip(QObject::tr("Checks whether an opened recording is good enough"));
  QObject::connect(action, &QAction::toggled, &workbench.check, [&workbench](bool on) {
    QSettings().setValue(kKey, on);
    workbench.check.setAutomatic(on);
  });
  return action;
}

}  // namespace evical::ui
