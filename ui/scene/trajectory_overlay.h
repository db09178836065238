// SPDX-License-Identifier: GPL-3.0-or-later
// Painted over a trajectory's picture: names, cursor, colour bar, texts.
#pragma once

#include "ui/scene/trajectory_scene.h"
#include "ui/scene/turntable_camera.h"

#include <QSizeF>

class QPainter;

namespace evical::ui {

struct TrajectoryOverlay {
  ViewPose pose;
  QSizeF screen;
  std::vector<SceneLabel> labels;
  std::vector<LegendEntry> legend;
  std::optional<Eigen::Vector3d> cursor_m;
  std::optional<ColourScale> scale;
  QString hint;     // small, in the corner
  QString message;  // in the middle if `in_middle`, else below
  bool in_middle = false;
};

void paintOverlay(QPainter& painter, const TrajectoryOverlay& overlay);

}  // namespace evical::ui
