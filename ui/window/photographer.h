// SPDX-License-Identifier: GPL-3.0-or-later
// Takes one picture of the desktop program: of a page, a dialog, or a checked recording.
#pragma once

#include <QObject>
#include <QStringList>
#include <QTemporaryDir>

namespace evical::ui {

class MainWindow;
struct JobError;

// Calibrates the session or opens the saved run, waits until the screen is drawn, saves its picture, and ends
// the program: with 0, or with 1 after a failure.
class Photographer : public QObject {
 public:
  // `further`: recordings in addition to the opened one, for pages that compare several.
  Photographer(MainWindow& window, QString screen, QString file, QStringList further = {});

  // Names of the pages and other pictures.
  static QStringList screensOf(const MainWindow& window);

 private:
  static void giveUp(const QString& what, const JobError& error);
  void opened();
  void calibrate();
  void waitAndSave();
  void openDialog();
  void checkResult();
  void repeat();
  void maintain();
  void jobDone();

  MainWindow& window_;
  QString screen_, file_;
  QStringList further_;
  QTemporaryDir results_;
};

}  // namespace evical::ui
