// SPDX-License-Identifier: GPL-3.0-or-later
// One sensor's pose in the usual representations, with a drawing of the rig; it can be copied in formats of
// other programs.
#pragma once

#include "core/report/sensor_pose.h"

#include <QScrollArea>

#include <vector>

class QComboBox;
class QFormLayout;
class QLabel;
class QMenu;
class QToolButton;

namespace evical::ui {

class RigDrawing;

class PosePanel : public QScrollArea {
  Q_OBJECT

 public:
  explicit PosePanel(QWidget* parent = nullptr);

  void setResult(const NamedResult& named);
  // "Copy as" for other menus too: the shown pose, or all poses.
  QMenu* copyMenu() const { return copy_menu_; }

 protected:
  void contextMenuEvent(QContextMenuEvent* event) override;

 private:
  QWidget* makeBar();
  void addNumbers(QFormLayout& form);
  void fillCopyMenu();
  void copy(const char* form, bool all);
  void showPose();

  std::vector<SensorPose> poses_;
  QComboBox* sensor_;
  QToolButton* copy_;
  QMenu* copy_menu_;
  RigDrawing* drawing_;
  QLabel *direction_, *said_, *translation_, *vector_, *angles_, *warning_, *quaternion_, *matrix_, *time_;
};

}  // namespace evical::ui
