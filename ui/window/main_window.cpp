// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/main_window.h"

#include "core/base/error.h"
#include "core/pipeline/session/idle_options.h"
#include "ui/detection/detection_screen.h"
#include "ui/forms/option_form.h"
#include "ui/forms/page_keys.h"
#include "ui/jobs/window_how_to.h"
#include "ui/plots/residuals_screen.h"
#include "ui/scene/trajectory_screen.h"
#include "ui/screens/recording/recording_screen.h"
#include "ui/screens/result/result_screen.h"
#include "ui/screens/result/runs_panel.h"
#include "ui/window/error_panel.h"
#include "ui/window/job_status.h"
#include "ui/window/kept_runs.h"
#include "ui/window/lens_files.h"
#include "ui/window/linked_pages.h"
#include "ui/window/log_panel.h"
#include "ui/window/session_files.h"
#include "ui/window/side_bar.h"
#include "ui/window/steps_panel.h"
#include "ui/window/workbench.h"

#include <QAction>
#include <QApplication>
#include <QCloseEvent>
#include <QDockWidget>
#include <QDropEvent>
#include <QLabel>
#include <QMessageBox>
#include <QMimeData>
#include <QPushButton>
#include <QScreen>
#include <QSettings>
#include <QSplitter>
#include <QStackedWidget>
#include <QStatusBar>
#include <QUrl>
#include <QVBoxLayout>

namespace evical::ui {
namespace {

constexpr int kLaidOut_turns = 3;  // until pages have their content and layout
// Increased when docks or tool bars change, so that a saved older layout is ignored.
constexpr int kLayoutVersion = 2;

// Undoable: a calibration from the same detections without some windows.
bool leavesOutOthers(const RunRecord& record, const RunRecord& last) {
  return last.run && rejectedTimes_s(record.run->detections) != rejectedTimes_s(last.run->detections);
}

}  // namespace

MainWindow::MainWindow(const QString& version)
    : workbench_(version),
      files_(new SessionFiles(workbench_, this)),
      lens_files_(new LensFiles(workbench_, this)) {
  speakWith(windowHowTo);
  setAcceptDrops(true);
  qApp->installEventFilter(new SessionUndoKeys(this));
  makeCentre();
  makeDocks();
  makeActions();
  auto* const status = new JobStatus(workbench_.runner, this);
  statusBar()->addWidget(status, 1);
  connect(&workbench_.document, &CalibrationDocument::sessionReplaced, status, &JobStatus::reset);
  connect(files_, &SessionFiles::reading, status, &JobStatus::setReading);
  connect(files_, &SessionFiles::reading, this, &MainWindow::showReading);
  wirePages(pages_, workbench_, *files_, *lens_files_);
  wireRuns(*runs_, *pages_.result, workbench_);
  connect(runs_, &RunsPanel::comparisonRequested, this, [this] { showScreen("result"); });
  connect(&workbench_.history, &RunHistory::failed, this, &MainWindow::showProblem);
  wireDocument();
  wireParameters();
  wireJobs();
  wireSteps();
  wireLens();
  restoreLayout();
  side_bar_->showPage(0);
  showState();
}

MainWindow::~MainWindow() = default;

void MainWindow::makeCentre() {
  stack_ = new PageStack(this);
  entries_ = buildPages(pages_, stack_);
  for (const PageEntry& entry : entries_) stack_->addWidget(entry.widget);
  error_ = new ErrorPanel(this);
  exported_ = new ExportNotice(this);
  auto* const pages = new QWidget(this);
  // The largest page would exceed small displays. An error takes its place from the page, not from the
  // display.
  pages->setMinimumSize(716, 396);
  auto* const column = new QVBoxLayout(pages);
  column->setContentsMargins(8, 8, 8, 8);
  column->addWidget(error_);
  column->addWidget(stack_, 1);
  column->addWidget(exported_);  // below: the page must not move under the mouse
  auto* const row = new QWidget(this);
  auto* const layout = new QHBoxLayout(row);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  steps_ = new StepsPanel(this);
  side_bar_ = new SideBar(entries_, steps_, this);
  connect(side_bar_, &SideBar::pageChosen, this, &MainWindow::turnTo);
  connect(side_bar_, &SideBar::pageClicked, this, [this] { stack_->currentWidget()->setFocus(); });
  layout->addWidget(side_bar_);
  layout->addWidget(pages, 1);
  setCentralWidget(row);
}

void MainWindow::makeDocks() {
  setDockOptions(AnimatedDocks | AllowNestedDocks | AllowTabbedDocks);
  log_ = new LogPanel(this);
  log_dock_ = addDock("log", tr("Log"), log_, Qt::BottomDockWidgetArea);
  log_dock_->hide();
  runs_ = new RunsPanel(this);
  runs_dock_ = addDock("runs", tr("Runs"), runs_, Qt::BottomDockWidgetArea);
  tabifyDockWidget(log_dock_, runs_dock_);
  runs_dock_->hide();
  parameters_ = new OptionForm(this);
  parameters_dock_ = addDock("parameters", tr("Parameters"), parameters_, Qt::RightDockWidgetArea);
  parameters_dock_->hide();
}

QDockWidget* MainWindow::addDock(const QString& name, const QString& title, QWidget* content,
                                 Qt::DockWidgetArea area) {
  auto* const dock = new QDockWidget(title, this);
  dock->setObjectName(name);  // needed by saveState
  dock->setWidget(content);
  addDockWidget(area, dock);
  return dock;
}

QStringList MainWindow::screenNames() const {
  QStringList names;
  for (const PageEntry& entry : entries_) names << entry.name;
  return names;
}

bool MainWindow::showScreen(const QString& name) {
  const qsizetype index = screenNames().indexOf(name);
  if (index < 0) return false;
  result_is_due_ = false;
  side_bar_->showPage(static_cast<int>(index));
  return true;
}

// Updates resume when pages have their content and layout: one turn of the event loop would take long.
void MainWindow::paintPagesLater() {
  stack_->setUpdatesEnabled(false);
  afterTurns(kLaidOut_turns, stack_, [this] { stack_->setUpdatesEnabled(true); });
}

void MainWindow::turnTo(int page) {
  // Its drawing library takes 80 MB, so it is loaded on demand.
  if (screenNames().value(page) == "trajectory") pages_.trajectory->startInBackground();
  paintPagesLater();
  stack_->setCurrentIndex(page);
}

void MainWindow::wireDocument() {
  connect(&workbench_.document, &CalibrationDocument::sessionChanged, this, &MainWindow::showState);
  connect(&workbench_.document, &CalibrationDocument::fileChanged, this, &MainWindow::showState);
  connect(&workbench_.document, &CalibrationDocument::runsChanged, this, &MainWindow::showState);
  connect(&workbench_.document, &CalibrationDocument::sessionChanged, this, &MainWindow::showRejections);
  connect(&workbench_.lens, &LensDocument::aimChanged, this, &MainWindow::showRejections);
  connect(&workbench_.document, &CalibrationDocument::sessionReplaced, this, [this] {
    steps_->reset();
    error_->hide();
    exported_->hide();
  });
  connect(pages_.residuals, &ResidualsScreen::windowWanted, this, [this](int camera, double time_s) {
    pages_.detection->setCamera(static_cast<std::size_t>(camera));
    pages_.detection->setTime(time_s);
    showScreen("detection");
  });
  connect(pages_.result, &ResultScreen::calibrateRequested, this, &MainWindow::calibrate);
  connect(pages_.result, &ResultScreen::repairRequested, this, &MainWindow::repair);
  connect(error_, &ErrorPanel::repairRequested, this, &MainWindow::repair);
  connect(files_, &SessionFiles::failed, this, &MainWindow::showProblem);
  connect(files_, &SessionFiles::opened, this, [this] {
    error_->hide();
    showScreen(workbench_.document.last().run ? "result" : "recording");
  });
  connect(files_, &SessionFiles::exported, this, [this](const ExportOutcome& outcome) {
    exported_->showOutcome(outcome);
    log_->add({LogLevel::Info, 0.0, tr("The result was exported to %1").arg(outcome.folder)});
  });
}

void MainWindow::wireParameters() {
  CalibrationDocument& document = workbench_.document;
  const auto types = std::make_shared<StreamTypes>();
  const auto show = [this, types] {
    const Session& session = workbench_.document.session();
    const std::vector<OptionRow> rows = documentedOptions(session.options);
    std::map<QString, QString> idle;
    for (const OptionRow& row : rows)
      if (const std::string why = whyIdle(session, row, *types); !why.empty())
        idle[QString::fromStdString(row.name)] = QString::fromStdString(why);
    parameters_->setRows(rows);
    parameters_->setIdle(workbench_.document.hasSession() ? idle : std::map<QString, QString>());
  };
  connect(&document, &CalibrationDocument::sessionChanged, parameters_, show);
  connect(&workbench_.inspection, &InspectionJob::inspected, parameters_,
          [types, show](const QString&, const std::shared_ptr<const Inspection>& inspection) {
            for (const StreamSummary& stream : inspection->streams)
              (*types)[stream.info.name] = stream.info.type;
            show();
          });
  connect(parameters_, &OptionForm::resetAllRequested, &document, &CalibrationDocument::resetOptions);
  connect(parameters_, &OptionForm::edited, this, [this](const QString& name, const QString& value) {
    try {
      workbench_.document.setOption(name, value);
    } catch (const CalibrationError& error) {
      parameters_->showRefusal(name, error);
    }
  });
  show();
}

void MainWindow::wireJobs() {
  JobRunner& runner = workbench_.runner;
  connect(&runner, &JobRunner::started, this, [this](const QString& title) {
    error_->hide();
    exported_->hide();
    log_->addHeading(title);
    showState();
  });
  connect(&runner, &JobRunner::logged, log_, &LogPanel::add);
  connect(&runner, &JobRunner::failed, this, [this](const JobError& error) {
    showProblem(tr("%1 failed").arg(workbench_.runner.title()), error);
  });
  connect(&runner, &JobRunner::finished, this, [this](JobOutcome outcome) {
    if (outcome == JobOutcome::Cancelled)
      log_->add({LogLevel::Warning, 0.0, tr("%1: cancelled").arg(workbench_.runner.title())});
    showState();
    if (close_when_idle_) close();
  });
  connect(&workbench_.calibration, &CalibrationJob::calibrated, this,
          [this](std::shared_ptr<const CalibrationRun> run, const Session& session, const QString& log) {
            paintPagesLater();
            RunRecord record{std::move(run), session, log};
            const bool same_detections = workbench_.calibration.startedFrom() == RunStart::Detections;
            if (same_detections && leavesOutOthers(record, workbench_.document.last()))
              workbench_.document.addUndoableRun(record, tr("Reject event windows"));
            else
              workbench_.document.addRun(std::move(record));
            showResultSoon();
          });
}

// After the pages are filled, and only if one of the first two is still shown.
void MainWindow::showResultSoon() {
  result_is_due_ = stack_->currentIndex() <= 1;
  afterTurns(kLaidOut_turns, this, [this] {
    if (result_is_due_) showScreen("result");
  });
}

void MainWindow::wireSteps() {
  JobRunner& runner = workbench_.runner;
  CalibrationJob& job = workbench_.calibration;
  const auto whileCalibrating = [this](auto&& act) {
    return [this, act](const auto&... given) {
      if (workbench_.calibration.running() || workbench_.intrinsics.running()) act(given...);
    };
  };
  connect(&runner, &JobRunner::started, this, whileCalibrating([this](const QString&) { steps_->reset(); }));
  connect(&runner, &JobRunner::stageStarted, this,
          whileCalibrating([this](const QString& stage) { steps_->startStage(stage); }));
  connect(&runner, &JobRunner::progressed, this,
          whileCalibrating([this](const JobProgress& progress) { steps_->setProgress(progress); }));
  connect(&job, &CalibrationJob::detectionsChanged, steps_,
          [this](const std::shared_ptr<const LiveDetections>& live) { steps_->setDetections(*live); });
  connect(&job, &CalibrationJob::initialisationStepDone, steps_, &StepsPanel::addInitialisationNote);
  connect(&job, &CalibrationJob::iterationsChanged, steps_,
          [this](const std::shared_ptr<const LiveIterations>& live) { steps_->setIterations(*live); });
  connect(&runner, &JobRunner::finished, steps_, &StepsPanel::finish);
  connect(&workbench_.document, &CalibrationDocument::runsChanged, steps_, [this] {
    const bool of_rig = workbench_.lens.aim() == CalibrationAim::Rig;
    const bool busy = workbench_.calibration.running();
    if (const auto run = workbench_.document.last().run; run && of_rig && !busy) steps_->setRun(*run);
  });
}

void MainWindow::calibrate() {
  const std::vector<SessionProblem> problems = workbench_.lens.problems();
  if (!problems.empty()) {
    showScreen(workbench_.document.hasSession() ? "recording" : "start");
    showProblem(tr("The session cannot be calibrated yet"), {true, {}, problems.front().text, {}});
    return;
  }
  const Session& session = workbench_.document.session();
  if (workbench_.lens.aim() == CalibrationAim::Camera)
    workbench_.intrinsics.start(session, workbench_.lens.camera());
  else
    calibrateRig(workbench_);
}

void MainWindow::repair(const Repair& repair) {
  if (workbench_.runner.running()) return;
  const QString key = QString::fromStdString(repair.key);
  Session changed = workbench_.document.session();
  try {
    setInSession(changed, repair.key, repair.value);
    validate(changed, "session");
  } catch (const CalibrationError& error) {
    showProblem(tr("%1 cannot be set").arg(key),
                {true, QString::fromStdString(error.place()), QString::fromStdString(error.problem()),
                 QString::fromStdString(error.advice())});
    return;
  }
  workbench_.document.edit(changed, tr("Set %1").arg(key));
  calibrate();
}

void MainWindow::cancel() {
  workbench_.runner.cancel();
  showState();
}

// The old session leaves the view at once: a large recording takes seconds to read.
void MainWindow::showReading(const QString& recording) {
  reading_ = recording;
  pages_.recording->setReading(recording);
  if (!recording.isEmpty()) error_->hide();
  showState();
  if (!recording.isEmpty()) showScreen("recording");
  if (recording.isEmpty() && !workbench_.document.hasSession()) showScreen("start");
}

void MainWindow::showRejections() {
  const int count = workbench_.lens.aim() == CalibrationAim::Rig ? workbench_.document.rejectedCount() : 0;
  rejected_->setText(count == 0   ? QString()
                     : count == 1 ? tr("without 1 rejected window")
                                  : tr("without %L1 rejected windows").arg(count));
  rejected_->setToolTip(count == 0 ? QString()
                                   : tr("Calibrations exclude the windows that were rejected on the pages "
                                        "Detection and Residuals"));
}

void MainWindow::showProblem(const QString& what_was_tried, const JobError& error) {
  error_->showError(what_was_tried, error);
  log_->add({LogLevel::Warning, 0.0, what_was_tried + ": " + error.text()});
}

void MainWindow::showState() {
  const CalibrationDocument& document = workbench_.document;
  const bool running = workbench_.runner.running();
  const bool reading = !reading_.isEmpty();
  setWindowTitle(reading                 ? reading_ + " - Evical"
                 : document.hasSession() ? document.title() + "[*] - Evical"
                                         : QString("Evical"));
  setWindowModified(!reading && document.modified());
  actions_.calibrate->setVisible(!running);
  actions_.calibrate->setEnabled(!running && !reading && document.hasSession());
  actions_.cancel->setVisible(running);
  actions_.cancel->setEnabled(running && !workbench_.runner.cancelling());
  for (QAction* const action : {actions_.open_session, actions_.open_recording}) action->setEnabled(!running);
  showPages();
  const bool unsaved = document.modified() || (document.hasSession() && document.file().isEmpty());
  actions_.save->setEnabled(!reading && unsaved);
  actions_.save_as->setEnabled(!reading && document.hasSession());
  const bool of_camera = workbench_.lens.aim() == CalibrationAim::Camera;
  const bool has_result = !reading && workbench_.lastStatus().has_value();
  actions_.export_result->setEnabled(!running && has_result);
  actions_.report->setEnabled(!running && has_result && !of_camera);
  actions_.report->setToolTip(of_camera
                                  ? tr("Reports exist only for rigs. See the Result page for a camera alone")
                              : has_result ? tr("Open the result's report in the browser (Ctrl+R)")
                                           : tr("There is no result yet: press Calibrate"));
}

// Why a page with this need has no content; empty: it has. A running calibration fills pages.
QString MainWindow::whyGrey(PageNeed need) const {
  if (need == PageNeed::Nothing) return {};
  if (!reading_.isEmpty()) return tr("Reading the recording");
  if (!workbench_.document.hasSession()) return tr("Open a recording first");
  if (need == PageNeed::RunOfRig && workbench_.lens.aim() == CalibrationAim::Camera)
    return tr("Grey pages are for rigs only");
  const bool calibrating = workbench_.calibration.running() || workbench_.intrinsics.running();
  if (need == PageNeed::Session || calibrating || workbench_.lastStatus()) return {};
  return tr("Press Calibrate to fill grey pages");
}

void MainWindow::showPages() {
  std::vector<QString> reasons;
  for (const PageEntry& entry : entries_)
    reasons.push_back(entry.name == "recording" && !reading_.isEmpty() ? QString() : whyGrey(entry.need));
  side_bar_->setReasons(reasons,
                        QString::fromStdString(workbench_.document.session().recording.filename().string()));
  for (std::size_t i = 0; i < entries_.size(); ++i) actions_.pages[i]->setEnabled(reasons[i].isEmpty());
  const bool reading = !reading_.isEmpty();
  side_bar_->setVerdict(static_cast<int>(screenNames().indexOf("result")),
                        reading ? std::nullopt : workbench_.lastStatus());
  steps_->setVisible(!reading && workbench_.document.hasSession());
}

void MainWindow::restoreLayout() {
  constexpr int kWidth_px = 1280, kHeight_px = 800;
  const QSettings settings;
  constexpr int kFrame_px = 48;  // title bar, not drawn yet
  const QSize free = screen()->availableGeometry().size() - QSize(0, kFrame_px);
  resize(QSize(kWidth_px, kHeight_px).boundedTo(free));
  constexpr int kLog_px = 190, kParameters_px = 280;
  resizeDocks({log_dock_}, {kLog_px}, Qt::Vertical);
  resizeDocks({parameters_dock_}, {kParameters_px}, Qt::Horizontal);
  restoreGeometry(settings.value("window/geometry").toByteArray());
  restoreState(settings.value("window/state").toByteArray(), kLayoutVersion);
}

void MainWindow::saveLayout() {
  QSettings settings;
  settings.setValue("window/geometry", saveGeometry());
  settings.setValue("window/state", saveState(kLayoutVersion));
}

bool MainWindow::mayInterrupt() {
  QMessageBox question(QMessageBox::Question, tr("Quit"),
                       tr("%1 is still running.").arg(workbench_.runner.title()),
                       QMessageBox::Yes | QMessageBox::No, this);
  question.setInformativeText(tr("If you quit now, it is cancelled and its result is lost."));
  question.button(QMessageBox::Yes)->setText(tr("&Cancel it and quit"));
  question.button(QMessageBox::No)->setText(tr("Continue &running"));
  question.setDefaultButton(QMessageBox::No);
  return question.exec() == QMessageBox::Yes;
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (workbench_.runner.running() && !close_when_idle_ && !mayInterrupt()) {
    event->ignore();
    return;
  }
  if (workbench_.runner.running()) {
    close_when_idle_ = true;
    cancel();
    event->ignore();
    return;
  }
  close_when_idle_ = false;
  if (!files_->mayDiscard()) {
    event->ignore();
    return;
  }
  saveLayout();
  event->accept();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  const QList<QUrl> urls = event->mimeData()->urls();
  if (urls.size() == 1 && urls.front().isLocalFile()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  const QList<QUrl> urls = event->mimeData()->urls();
  if (urls.size() != 1 || !urls.front().isLocalFile()) return;
  event->acceptProposedAction();
  // The drag's source waits until this returns: questions are asked afterwards.
  QMetaObject::invokeMethod(
      this, [this, path = urls.front().toLocalFile()] { files_->open(path); }, Qt::QueuedConnection);
}

}  // namespace evical::ui
