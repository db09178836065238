// SPDX-License-Identifier: GPL-3.0-or-later
// Takes one picture of the desktop program: of a page, a dialog, or a recording that was just looked through.
#pragma once

#include <QObject>
#include <QStringList>

namespace evical::ui {

class MainWindow;
struct JobError;

// Calibrates the session, or opens the saved run, lets the screen draw what it got, saves its picture, and ends the
// program: with 0, or with 1 where something failed.
class Photographer : public QObject {
 public:
  Photographer(MainWindow& window, QString screen, QString file);

  // Pages, and what else there are pictures of.
  static QStringList screensOf(const MainWindow& window);

 private:
  static void giveUp(const QString& what, const JobError& error);
  void opened();
  void calibrate();
  void waitAndSave();
  void openDialog();

  MainWindow& window_;
  QString screen_, file_;
};

}  // namespace evical::ui
