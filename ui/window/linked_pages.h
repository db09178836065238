// SPDX-License-Identifier: GPL-3.0-or-later
// Screens that show a run, during and after it, with a common time cursor.
#pragma once

#include "ui/window/pages.h"

#include "ui/document/calibration_aim.h"

#include <QStackedWidget>

namespace evical::ui {

struct Pages;
struct Workbench;

// Calibrates the session. Existing detections are used again if nothing that they depend on has changed.
void calibrateRig(Workbench& workbench);

void wireLinkedPages(const Pages& pages, Workbench& workbench);

// Follows a recording that another program is still writing: offers it, checks it again as it grows, and
// makes all pages read it again at its end.

void wireFollowing(const Pages& pages, Workbench& workbench);

// Wraps a page that is for rigs only; while a camera alone is calibrated, shows a note instead.
class RigPage : public QStackedWidget {
  Q_OBJECT

 public:
  // `what`: content of the page with its verb, as in "Trajectories belong".
  RigPage(QWidget* page, const QString& what, QWidget* parent);

  void setAim(CalibrationAim aim);

 signals:
  void rigRequested();
};

}  // namespace evical::ui
