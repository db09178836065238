// SPDX-License-Identifier: GPL-3.0-or-later
// One sensor's pose with a drawing of the rig: translation, quaternion and time offset; other representations
// of the rotation on a click. It can be copied in formats of other programs.
#pragma once

#include "core/report/shown_quantity.h"

#include <QScrollArea>

#include <vector>

class QComboBox;
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
  QWidget* makeNumbers();
  QWidget* makeMore();
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
