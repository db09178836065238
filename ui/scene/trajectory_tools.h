// SPDX-License-Identifier: GPL-3.0-or-later
// Tool bar of the trajectory screen: colour, layers, views, following the camera. Continues in a second row
// if space is short.
#pragma once

#include "ui/scene/trajectory_scene.h"
#include "ui/scene/turntable_camera.h"

#include <QWidget>

#include <array>
#include <utility>
#include <vector>

class QComboBox;
class QMenu;
class QToolButton;

namespace evical::ui {

class TrajectoryTools : public QWidget {
  Q_OBJECT

 public:
  explicit TrajectoryTools(QWidget* parent = nullptr);

  bool following() const;      // the view's focus follows the camera
  bool throughCamera() const;  // view from the camera
  void leaveCamera();

  void showColour(TrajectoryColour colour);
  void showLayer(SceneLayer layer, bool visible);
  void offerResiduals(bool available);
  void offerTable(bool available);
  QMenu* saveMenu() const { return save_; }

 signals:
  void colourChosen(evical::ui::TrajectoryColour colour);
  void layerToggled(evical::ui::SceneLayer layer, bool visible);
  void viewChosen(evical::ui::StandardView view);
  void followingChanged();
  void pictureWanted(double scale);  // pixels of the picture per screen pixel
  void tableWanted();

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void addColours();
  void addLayers();
  void addViews();
  void addFollowing();
  void addSaving();
  QToolButton* addButton(const QString& text, const QString& icon_name, const QString& help);
  void applyIcons();

  std::vector<std::pair<QToolButton*, QString>> icons_;
  QComboBox* colours_ = nullptr;
  QMenu* save_ = nullptr;
  QAction* table_ = nullptr;
  std::array<QAction*, kSceneLayerCount> layers_{};
  QAction *follow_ = nullptr, *through_ = nullptr;
};

}  // namespace evical::ui
