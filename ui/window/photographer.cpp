// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/photographer.h"

#include "ui/screens/assessment/file_list.h"
#include "ui/screens/assessment/maintain_screen.h"
#include "ui/screens/assessment/path_row.h"
#include "ui/screens/assessment/repeat_screen.h"
#include "ui/screens/assessment/result_check_screen.h"
#include "ui/window/main_window.h"
#include "ui/window/print_board.h"
#include "ui/window/session_files.h"

#include <QApplication>
#include <QDialog>
#include <QTabWidget>
#include <QTextStream>
#include <QTimer>

namespace evical::ui {
namespace {

constexpr int kDone = 0, kFailed = 1;
constexpr int kSettle_ms = 2500;  // screens prepare their contents in separate threads
const char* const kCheck = "check";
const char* const kPrintBoard = "print-board";
const char* const kHowToRecord = "how-to-record";
const char* const kExport = "export";
// Pages that need further recordings.
const char *const kCheckResult = "check-result", *const kRepeat = "repeat";
// The first argument is a log, the second the old result; the page has two tabs.
const char *const kMaintain = "maintain", *const kOverTime = "maintain-over-time";

void complain(const QString& text) {
  QTextStream(stderr) << text << '\n';
}

// The open dialog, else the window.
QWidget* shownOf(MainWindow& window) {
  for (QWidget* const widget : QApplication::topLevelWidgets())
    if (qobject_cast<QDialog*>(widget) && widget->isVisible()) return widget;
  return &window;
}

}  // namespace

Photographer::Photographer(MainWindow& window, QString screen, QString file, QStringList further)
    : window_(window), screen_(std::move(screen)), file_(std::move(file)), further_(std::move(further)) {
  Workbench& workbench = window.workbench();
  connect(&window.files(), &SessionFiles::opened, this, &Photographer::opened);
  connect(&window.files(), &SessionFiles::failed, this, &Photographer::giveUp);
  connect(&workbench.runner, &JobRunner::failed, this,
          [](const JobError& error) { giveUp("calibrate", error); });
  connect(&workbench.runner, &JobRunner::finished, this, [this](JobOutcome outcome) {
    if (outcome == JobOutcome::Done) jobDone();
  });
  if (screen_ == kCheckResult && !further_.isEmpty())
    connect(&workbench.history, &RunHistory::changed, this, &Photographer::checkResult);
  if (screen_ != kCheck) return;
  connect(&workbench.check, &RecordingCheckJob::checkedAnew, this, &Photographer::waitAndSave);
  connect(&workbench.check, &RecordingCheckJob::failed, this,
          [](const JobError& error) { giveUp("check", error); });
}

QStringList Photographer::screensOf(const MainWindow& window) {
  return window.screenNames() + QStringList{kCheck, kPrintBoard, kHowToRecord, kExport, kOverTime};
}

void Photographer::giveUp(const QString& what, const JobError& error) {
  complain(what + ": " + error.text());
  QTimer::singleShot(0, qApp, [] { QCoreApplication::exit(kFailed); });  // exec() may not have started
}

void Photographer::opened() {
  if (screen_ == kCheck) return window_.workbench().check.setAutomatic(true);
  if (screen_ == kRepeat && !further_.isEmpty()) return repeat();
  if (screen_.startsWith(kMaintain)) return further_.isEmpty() ? waitAndSave() : maintain();
  const bool needs_a_run = screen_ != kPrintBoard && screen_ != kHowToRecord && screen_ != "start";
  if (!needs_a_run || window_.workbench().document.last().run) return waitAndSave();
  calibrate();
}

void Photographer::calibrate() {
  LensDocument& lens = window_.workbench().lens;
  if (lens.offersCameraOnly()) lens.setAim(CalibrationAim::Camera);
  window_.calibrate();
  if (!window_.workbench().runner.running()) giveUp("calibrate", {true, {}, "the session is incomplete", {}});
}

// After the run is stored: its folder is the old result.
void Photographer::checkResult() {
  Workbench& workbench = window_.workbench();
  auto* const screen = window_.findChild<ResultCheckScreen*>();
  if (workbench.runner.running() || workbench.history.folderOf(workbench.document.last().run).empty() ||
      !screen->recording().path().isEmpty())
    return;
  screen->recording().setPath(further_.front());
  emit screen->startRequested();
}

void Photographer::repeat() {
  auto* const screen = window_.findChild<RepeatScreen*>();
  screen->files().add(QStringList{window_.workbench().document.file()} + further_);
  screen->folder().setPath(results_.filePath("together"));
  emit screen->startRequested();
}

void Photographer::maintain() {
  auto* const screen = window_.findChild<MaintainScreen*>();
  screen->logs().add({QString::fromStdString(window_.workbench().document.session().recording.string())});
  screen->result().setPath(further_.front());
  emit screen->startRequested();
}

void Photographer::jobDone() {
  const bool more = screen_ == kCheckResult && !further_.isEmpty() &&
                    window_.findChild<ResultCheckScreen*>()->recording().path().isEmpty();
  if (!more) waitAndSave();
}

void Photographer::openDialog() {
  if (screen_ == kPrintBoard) showPrintBoard(&window_, window_.workbench());
  if (screen_ == kHowToRecord) showHowToRecord(&window_);
  if (screen_ == kExport)  // modal: blocks until it is answered
    QTimer::singleShot(0, &window_, [this] { window_.files().chooseExportFolder(); });
}

void Photographer::waitAndSave() {
  if (window_.screenNames().contains(screen_)) window_.showScreen(screen_);
  if (screen_ == kCheck) window_.showScreen("recording");
  if (screen_ == kOverTime && window_.showScreen(kMaintain))
    window_.findChild<QTabWidget*>("maintain_tabs")->setCurrentIndex(1);
  openDialog();
  QTimer::singleShot(kSettle_ms, this, [this] {
    const bool saved = shownOf(window_)->grab().save(file_);
    if (!saved) complain(file_ + ": cannot be written");
    QCoreApplication::exit(saved ? kDone : kFailed);
  });
}

}  // namespace evical::ui
