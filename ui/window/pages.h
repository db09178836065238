// SPDX-License-Identifier: GPL-3.0-or-later
// The screens, in the order of the side bar: buildPages creates them, wirePages connects them with the
// workbench and with each other. Screens themselves depend on neither.
#pragma once

#include <QKeySequence>
#include <QString>
#include <QWidget>

#include <cstddef>
#include <vector>

class QStackedWidget;
class QObject;

namespace evical::ui {

struct Workbench;
class ConvergenceScreen;
class DetectionScreen;
class LensFiles;
class LensScreen;
class MaintainScreen;
class MaintenanceCharts;
class RecordingScreen;
class RepeatScreen;
class ResidualsScreen;
class ResultCheckScreen;
class ResultScreen;
class RigPage;
class SessionFiles;
class SignalsScreen;
class StartScreen;
class TrajectoryScreen;

struct Pages {
  StartScreen* start = nullptr;
  RecordingScreen* recording = nullptr;
  DetectionScreen* detection = nullptr;
  TrajectoryScreen* trajectory = nullptr;
  ConvergenceScreen* convergence = nullptr;
  SignalsScreen* signal_curves = nullptr;
  ResidualsScreen* residuals = nullptr;
  ResultScreen* result = nullptr;
  LensScreen* lens = nullptr;
  QStackedWidget* results = nullptr;  // the last two: for a rig, for a camera alone
  ResultCheckScreen* result_check = nullptr;
  RepeatScreen* repeat = nullptr;
  MaintainScreen* maintain = nullptr;
  MaintenanceCharts* maintenance_charts = nullptr;  // part of `maintain`
  std::vector<RigPage*> of_rigs;                    // wrappers of the pages that are for rigs only
};

// Heading of the side bar under which a page is listed, and what the page needs to have content.
enum class PageGroup { None, ThisRecording, More };
enum class PageNeed { Nothing, Session, Run, RunOfRig };

// A page in the side bar.
struct PageEntry {
  QString name;  // for --screenshot
  QString title, icon_name;
  QWidget* widget = nullptr;
  PageGroup group = PageGroup::None;
  PageNeed need = PageNeed::Nothing;
};

// Ctrl+1 to Ctrl+9, Ctrl+0, then Ctrl+Shift+1 and so on.
QKeySequence keyOfPage(std::size_t index);

std::vector<PageEntry> buildPages(Pages& pages, QWidget* parent);

void wirePages(const Pages& pages, Workbench& workbench, SessionFiles& files, LensFiles& lens_files);

// Content of the screens during the calibration of a camera alone, and its result.

struct Pages;

// Call after the other pages are wired: the slots for a camera alone must run after those for a rig.
void wireLensPages(const Pages& pages, Workbench& workbench, LensFiles& files);

}  // namespace evical::ui
