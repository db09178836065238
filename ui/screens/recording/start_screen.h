// SPDX-License-Identifier: GPL-3.0-or-later
// Start page: open a recording or a session, continue with a recent one, or try the demo.
#pragma once

#include <QStringList>
#include <QWidget>

class QLabel;
class QListWidget;
class QProgressBar;
class QPushButton;

namespace evical::ui {

class AimChooser;

class StartScreen : public QWidget {
  Q_OBJECT

 public:
  explicit StartScreen(QWidget* parent = nullptr);

  void setRecentFiles(const QStringList& files);  // newest first
  void setDemoProgress(double fraction);          // during its simulation
  void setDemoRunning(bool running);
  AimChooser& aim() const { return *aim_; }  // what is calibrated

 signals:
  void openRecordingRequested();
  void openSessionRequested();
  void demoRequested();
  void printBoardRequested();
  void howToRecordRequested();
  void fileChosen(const QString& file);  // a recent file

 private:
  QWidget* makeChoices();
  QWidget* makeRecent();

  QListWidget* recent_;
  QLabel* no_recent_;
  QPushButton* demo_;
  QProgressBar* demo_progress_;
  AimChooser* aim_;
};

}  // namespace evical::ui
