// SPDX-License-Identifier: GPL-3.0-or-later
// The tool bar of the trajectory screen: colour, layers, views, following the camera.
#pragma once

#include "ui/scene/trajectory_scene.h"
#include "ui/scene/turntable_camera.h"

#include <QToolBar>

#include <array>

class QComboBox;

namespace evical::ui {

class TrajectoryTools : public QToolBar {
  Q_OBJECT

 public:
  explicit TrajectoryTools(QWidget* parent = nullptr);

  bool following() const;      // the focus goes with the camera
  bool throughCamera() const;  // the view is the camera's
  void leaveCamera();

  void showColour(TrajectoryColour colour);
  void showLayer(SceneLayer layer, bool visible);
  void offerResiduals(bool available);

 signals:
  void colourChosen(evical::ui::TrajectoryColour colour);
  void layerToggled(evical::ui::SceneLayer layer, bool visible);
  void viewChosen(evical::ui::StandardView view);
  void followingChanged();

 private:
  void addColours();
  void addLayers();
  void addViews();
  void addFollowing();

  QComboBox* colours_ = nullptr;
  std::array<QAction*, kSceneLayerCount> layers_{};
  QAction *follow_ = nullptr, *through_ = nullptr;
};

}  // namespace evical::ui
