// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/about.h"
#include "ui/window/lens_files.h"
#include "ui/window/log_panel.h"
#include "ui/window/main_window.h"
#include "ui/window/print_board.h"
#include "ui/window/recent_files.h"
#include "ui/window/recording_check.h"
#include "ui/window/session_files.h"
#include "ui/window/steps_panel.h"
#include "ui/window/user_guide.h"

#include "ui/screens/lens/lens_screen.h"
#include "ui/screens/recording/recording_screen.h"
#include "ui/screens/result/result_screen.h"
#include "ui/theme/theme.h"

#include <QAction>
#include <QActionGroup>
#include <QApplication>
#include <QDockWidget>
#include <QLabel>
#include <QMenu>
#include <QMenuBar>
#include <QSettings>
#include <QStackedWidget>
#include <QToolBar>
#include <QToolButton>

// Parts of the window for the calibration of a camera alone.

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

namespace evical::ui {
namespace {

QAction* makeAction(QMainWindow* window, const QString& icon_name, const QString& text, const QString& tip,
                    const QKeySequence& keys) {
  auto* const action = new QAction(icon(icon_name), text, window);
  action->setShortcut(keys);
  const QString shown = keys.toString(QKeySequence::NativeText);
  action->setToolTip(shown.isEmpty() ? tip : QString("%1 (%2)").arg(tip, shown));
  return action;
}

}  // namespace

void MainWindow::makeActions() {
  makeFileMenu();
  makeEditMenu();
  makeCalibrateMenu();
  makeViewMenu();
  makeHelpMenu();
  makeToolBar();
}

void MainWindow::makeFileMenu() {
  actions_.open_session = makeAction(this, "open", tr("&Open..."),
                                     tr("Open a session, a result or a recording"), QKeySequence::Open);
  actions_.open_recording = makeAction(this, "recording", tr("Open &recording..."),
                                       tr("Open a recording and describe it"), QKeySequence("Ctrl+Shift+O"));
  actions_.save = makeAction(this, "save", tr("&Save"), tr("Save the session"), QKeySequence::Save);
  actions_.save->setObjectName("save");
  actions_.save_as = makeAction(this, "save", tr("Save &as..."), tr("Save the session to another file"),
                                QKeySequence("Ctrl+Shift+S"));
  actions_.export_result = makeAction(this, "export", tr("&Export result..."),
                                      tr("Write the result's files to a folder"), QKeySequence("Ctrl+E"));
  actions_.export_every = makeAction(this, "export", tr("Export e&very result..."),
                                     tr("Write each new result to a folder"), QKeySequence());
  actions_.export_every->setCheckable(true);
  actions_.report = makeAction(this, "report", tr("Open re&port"), {}, QKeySequence("Ctrl+R"));
  actions_.quit = makeAction(this, "close", tr("&Quit"), tr("Quit the program"), QKeySequence("Ctrl+Q"));
  connect(actions_.open_session, &QAction::triggered, files_, &SessionFiles::chooseSession);
  connect(actions_.open_recording, &QAction::triggered, files_, &SessionFiles::chooseRecording);
  connect(actions_.save, &QAction::triggered, files_, &SessionFiles::save);
  connect(actions_.save_as, &QAction::triggered, files_, &SessionFiles::saveAs);
  connect(actions_.export_result, &QAction::triggered, this, &MainWindow::exportResult);
  connect(actions_.export_every, &QAction::triggered, files_, &SessionFiles::exportEveryResult);
  connect(actions_.report, &QAction::triggered, files_, &SessionFiles::openReport);
  connect(files_, &SessionFiles::exportsEveryResult, actions_.export_every, &QAction::setChecked);
  connect(actions_.quit, &QAction::triggered, this, &QWidget::close);

  QMenu* const menu = menuBar()->addMenu(tr("&File"));
  menu->addActions({actions_.open_session, actions_.open_recording});
  QMenu* const recent = menu->addMenu(icon("recent"), tr("Open re&cent"));
  connect(recent, &QMenu::aboutToShow, this, [this, recent] {
    recent->clear();
    for (const RecentFile& file : recentFiles())
      recent->addAction(file.path, files_, [this, path = file.path] { files_->openRecent(path); });
    recent->setEnabled(!recent->isEmpty());
  });
  menu->addSeparator();
  QAction* const print_board = makeAction(this, "board", tr("Print a &board..."),
                                          tr("A target for the camera, to scale"), QKeySequence());
  print_board->setObjectName("print_board_action");
  connect(print_board, &QAction::triggered, this, [this] { showPrintBoard(this, workbench_); });
  menu->addAction(print_board);
  menu->addSeparator();
  menu->addActions({actions_.save, actions_.save_as});
  menu->addSeparator();
  menu->addActions({actions_.export_result, actions_.export_every, actions_.report});
  menu->addSeparator();
  menu->addAction(actions_.quit);
}

void MainWindow::makeEditMenu() {
  QUndoStack& stack = workbench_.document.undoStack();
  actions_.undo = stack.createUndoAction(this, tr("&Undo"));
  actions_.undo->setIcon(icon("undo"));
  actions_.undo->setShortcut(QKeySequence::Undo);
  actions_.redo = stack.createRedoAction(this, tr("&Redo"));
  actions_.redo->setIcon(icon("redo"));
  actions_.redo->setShortcuts({QKeySequence("Ctrl+Shift+Z"), QKeySequence("Ctrl+Y")});
  QMenu* const menu = menuBar()->addMenu(tr("&Edit"));
  menu->addActions({actions_.undo, actions_.redo});
  menu->addSeparator();
  menu->addAction(pages_.result->copyMenu()->menuAction());
}

void MainWindow::makeCalibrateMenu() {
  actions_.calibrate = makeAction(this, "calibrate", tr("&Calibrate"),
                                  tr("Read, detect, initialise and optimise"), QKeySequence("F5"));
  actions_.cancel =
      makeAction(this, "cancel", tr("Ca&ncel"), tr("Cancel the running job"), QKeySequence("Shift+F5"));
  actions_.calibrate->setIcon(icon("calibrate", QPalette::HighlightedText));
  actions_.calibrate->setIconVisibleInMenu(false);  // its colour is for the button's background
  connect(actions_.calibrate, &QAction::triggered, this, &MainWindow::calibrate);
  connect(actions_.cancel, &QAction::triggered, this, &MainWindow::cancel);
  menuBar()
      ->addMenu(tr("&Calibrate"))
      ->addActions({actions_.calibrate, actions_.cancel, makeCheckAction(workbench_, this)});
}

void MainWindow::makeViewMenu() {
  QMenu* const menu = menuBar()->addMenu(tr("&View"));
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    QAction* const action = menu->addAction(icon(entries_[i].icon_name), entries_[i].title);
    action->setShortcut(keyOfPage(i));
    actions_.pages.push_back(action);
    connect(action, &QAction::triggered, this, [this, name = entries_[i].name] {
      showScreen(name);
      stack_->currentWidget()->setFocus();
    });
  }
  menu->addSeparator();
  QAction* const parameters = parameters_dock_->toggleViewAction();
  parameters->setIcon(icon("parameters"));
  parameters->setShortcut(QKeySequence("Ctrl+P"));
  menu->addAction(parameters);
  QAction* const log = log_dock_->toggleViewAction();
  log->setIcon(icon("log"));
  log->setShortcut(QKeySequence("Ctrl+L"));
  menu->addAction(log);
  QAction* const runs = runs_dock_->toggleViewAction();
  runs->setIcon(icon("recent"));
  runs->setShortcut(QKeySequence("Ctrl+H"));
  runs->setToolTip(tr("Runs of this session: open, compare, rename and delete them (Ctrl+H)"));
  menu->addAction(runs);
  menu->addSeparator();
  QMenu* const appearance = menu->addMenu(icon("theme"), tr("&Appearance"));
  auto* const group = new QActionGroup(this);
  const int now = QSettings().value("appearance", static_cast<int>(Appearance::System)).toInt();
  const std::pair<Appearance, QString> choices[] = {{Appearance::System, tr("Follow the &system")},
                                                    {Appearance::Light, tr("&Light")},
                                                    {Appearance::Dark, tr("&Dark")}};
  for (const auto& [choice, text] : choices) {
    QAction* const action = group->addAction(appearance->addAction(text));
    action->setCheckable(true);
    action->setChecked(now == static_cast<int>(choice));
    connect(action, &QAction::triggered, this, [chosen = choice] {
      QSettings().setValue("appearance", static_cast<int>(chosen));
      applyTheme(*qApp, chosen);
    });
  }
}

void MainWindow::makeHelpMenu() {
  actions_.guide = makeAction(this, "book", tr("&User guide"), tr("User guide"), QKeySequence::HelpContents);
  actions_.keys = makeAction(this, "keyboard", tr("&Keyboard"), tr("All keys"), QKeySequence("?"));
  connect(actions_.keys, &QAction::triggered, this, [this] { showKeys(this); });
  actions_.about = makeAction(this, "info", tr("&About Evical"), tr("About Evical"), {});
  connect(actions_.guide, &QAction::triggered, this, [this] { showUserGuide(this); });
  connect(actions_.about, &QAction::triggered, this, [this] { showAbout(this, workbench_.version); });
  QAction* const how =
      makeAction(this, "play", tr("How to &record..."), tr("The motions that a recording needs"), {});
  connect(how, &QAction::triggered, this, [this] { showHowToRecord(this); });
  menuBar()->addMenu(tr("&Help"))->addActions({actions_.guide, actions_.keys, how, actions_.about});
}

void MainWindow::makeToolBar() {
  constexpr int kIcon_px = 20;
  QToolBar* const bar = addToolBar(tr("Main"));
  bar->setObjectName("main");
  bar->setMovable(false);
  bar->setIconSize(QSize(kIcon_px, kIcon_px));
  bar->addActions({actions_.open_session, actions_.save});
  bar->addSeparator();
  bar->addActions({actions_.undo, actions_.redo});
  bar->addSeparator();
  bar->addActions({actions_.calibrate, actions_.cancel});
  for (QAction* const action : {actions_.calibrate, actions_.cancel}) {
    auto* const button = qobject_cast<QToolButton*>(bar->widgetForAction(action));
    button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    button->setProperty("primary", action == actions_.calibrate);
    button->setObjectName(action == actions_.calibrate ? "calibrate" : "cancel");
  }
  bar->addActions({actions_.report, actions_.export_result});
  rejected_ = new QLabel(bar);
  rejected_->setObjectName("rejected_windows");
  rejected_->setProperty("role", "hint");
  rejected_->setContentsMargins(8, 0, 8, 0);
  bar->addWidget(rejected_);  // after the buttons: they must not move
  auto* const space = new QWidget(bar);
  space->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  bar->addWidget(space);
  bar->addAction(parameters_dock_->toggleViewAction());
  bar->addAction(log_dock_->toggleViewAction());
  bar->addAction(runs_dock_->toggleViewAction());
  bar->addAction(actions_.guide);
}

}  // namespace evical::ui
