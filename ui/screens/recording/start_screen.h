// SPDX-License-Identifier: GPL-3.0-or-later
// Start page: three steps (print, record, open), recent files, and the demo.
#pragma once

#include "core/data/calibration_status.h"

#include <QDateTime>
#include <QList>
#include <QString>
#include <QWidget>

#include <optional>

class QLabel;
class QProgressBar;
class QPushButton;
class QTreeWidget;

namespace evical::ui {

// A file that was opened earlier.
struct RecentFile {
  QString path;
  QDateTime opened;
  std::optional<CalibrationStatus> verdict;  // of its last calibration
};

class StartScreen : public QWidget {
  Q_OBJECT

 public:
  explicit StartScreen(QWidget* parent = nullptr);

  void setRecentFiles(const QList<RecentFile>& files);  // newest first
  void setDemoProgress(double fraction);                // during its simulation
  void setDemoRunning(bool running);

 signals:
  void openRecordingRequested();
  void openSessionRequested();
  void demoRequested();
  void printBoardRequested();
  void howToRecordRequested();
  void fileChosen(const QString& file);  // a recent file

 protected:
  void changeEvent(QEvent* event) override;

 private:
  QWidget* makeSteps();
  QWidget* makeRecent();
  QWidget* makeDemo();
  void fillRecent();

  QList<RecentFile> files_;
  QTreeWidget* recent_;
  QLabel* no_recent_;
  QPushButton* demo_;
  QProgressBar* demo_progress_;
};

// Pictures of two of the three steps on the start page: a sheet with a board, and the events of a moving
// board. The step between them is a MotionPicture.
class StartPicture : public QWidget {
 public:
  enum class Shows { Sheet, Events };
  StartPicture(Shows shows, QWidget* parent) : QWidget(parent), shows_(shows) {}
  QSize sizeHint() const override { return {300, 300}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  Shows shows_;
};

}  // namespace evical::ui
