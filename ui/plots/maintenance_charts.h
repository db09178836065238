// SPDX-License-Identifier: GPL-3.0-or-later
// IMUs over time: numbers of two of them, or of a trajectory's sections, each with its sigma and the changes;
// and the residuals of gravity's norm at stops.
#pragma once

#include "core/data/assessment.h"

#include <QWidget>

#include <vector>

class QComboBox;
class QGridLayout;

namespace evical::ui {

class PlotPanel;

class MaintenanceCharts : public QWidget {
  Q_OBJECT

 public:
  explicit MaintenanceCharts(QWidget* parent = nullptr);

  void setMaintenance(const Maintenance& maintenance);
  const std::vector<PlotPanel*>& panels() const { return panels_; }  // for the current choice

 private:
  void show(int choice);
  void showTrack(const MaintenanceTrack& track);
  void showStops(const MaintainedImu& imu);
  PlotPanel* addPanel(const QString& title, const QString& unit);

  QComboBox* what_;
  QGridLayout* grid_;
  std::vector<PlotPanel*> panels_;
  std::vector<const MaintainedImu*>
      stopped_;  // of the maintenance, in the order of the box, after the tracks
  Maintenance maintenance_;
};

}  // namespace evical::ui
