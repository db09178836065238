// SPDX-License-Identifier: GPL-3.0-or-later
// The window: navigation, screens, steps, docks, menus, status bar.
#pragma once

#include "ui/window/pages.h"
#include "ui/window/workbench.h"

#include <QMainWindow>
#include <QStringList>

#include <optional>

class QAction;
class QDockWidget;
class QLabel;
class QStackedWidget;

namespace evical::ui {

class ErrorPanel;
class ExportNotice;
class LensFiles;
class LogPanel;
class OptionForm;
class RunsPanel;
class SessionFiles;
class SideBar;
class StepsPanel;

class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  explicit MainWindow(const QString& version);
  ~MainWindow() override;

  Workbench& workbench() { return workbench_; }
  SessionFiles& files() { return *files_; }
  LensFiles& lensFiles() { return *lens_files_; }
  QStringList screenNames() const;
  bool showScreen(const QString& name);  // false: unknown name

 public slots:
  void calibrate();
  void repair(const Repair& repair);  // sets it in the session, and calibrates again
  void cancel();

 protected:
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  void makeCentre();
  void makeDocks();
  void makeActions();
  void makeFileMenu();
  void makeEditMenu();
  void makeCalibrateMenu();
  void makeViewMenu();
  void makeHelpMenu();
  void makeToolBar();
  QDockWidget* addDock(const QString& name, const QString& title, QWidget* content, Qt::DockWidgetArea area);
  void wireDocument();
  void wireParameters();
  void wireJobs();
  void paintPagesLater();
  void turnTo(int page);
  void wireLens();
  void exportResult();
  void showResultSoon();
  void wireSteps();
  void showState();
  void showRejections();
  void showReading(const QString& recording);
  bool mayInterrupt();
  QString whyGrey(PageNeed need) const;
  void showPages();
  void showProblem(const QString& what_was_tried, const JobError& error);
  void restoreLayout();
  void saveLayout();

  Workbench workbench_;
  SessionFiles* files_;
  LensFiles* lens_files_;
  Pages pages_;
  std::vector<PageEntry> entries_;
  SideBar* side_bar_ = nullptr;
  QStackedWidget* stack_ = nullptr;
  StepsPanel* steps_ = nullptr;
  ErrorPanel* error_ = nullptr;
  ExportNotice* exported_ = nullptr;
  LogPanel* log_ = nullptr;
  OptionForm* parameters_ = nullptr;
  RunsPanel* runs_ = nullptr;
  QDockWidget *log_dock_ = nullptr, *parameters_dock_ = nullptr, *runs_dock_ = nullptr;
  struct Actions {
    QAction *open_session, *open_recording, *save, *save_as, *export_result, *export_every, *report, *quit;
    QAction *undo, *redo;
    std::vector<QAction*> pages;
    QAction *calibrate, *cancel;
    QAction *guide, *keys, *about;
  } actions_{};
  QLabel* rejected_ = nullptr;  // number of windows that calibrations exclude
  QString reading_;             // recording that will replace the session
  bool close_when_idle_ = false;
  bool result_is_due_ = false;  // unless another screen is chosen
};

}  // namespace evical::ui
