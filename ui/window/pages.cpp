// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/pages.h"

#include "ui/screens/start_screen.h"
#include "ui/window/session_files.h"
#include "ui/window/workbench.h"

namespace evical::ui {
namespace {

void wireStart(StartScreen& start, Workbench& workbench, SessionFiles& files) {
  start.setRecentFiles(files.recentFiles());
  QObject::connect(&start, &StartScreen::openRecordingRequested, &files, &SessionFiles::chooseRecording);
  QObject::connect(&start, &StartScreen::openSessionRequested, &files, &SessionFiles::chooseSession);
  QObject::connect(&start, &StartScreen::demoRequested, &files, &SessionFiles::openDemo);
  QObject::connect(&start, &StartScreen::fileChosen, &files, &SessionFiles::open);
  QObject::connect(&files, &SessionFiles::recentFilesChanged, &start, &StartScreen::setRecentFiles);
  QObject::connect(&files, &SessionFiles::demoRunning, &start, &StartScreen::setDemoRunning);
  QObject::connect(&workbench.runner, &JobRunner::progressed, &start,
                   [&start](const JobProgress& progress) { start.setDemoProgress(progress.fraction); });
}

}  // namespace

std::vector<PageEntry> buildPages(Pages& pages, QWidget* parent) {
  pages.start = new StartScreen(parent);
  return {{"start", QObject::tr("Start"), "home", pages.start}};
}

void wirePages(const Pages& pages, Workbench& workbench, SessionFiles& files) {
  wireStart(*pages.start, workbench, files);
}

}  // namespace evical::ui
