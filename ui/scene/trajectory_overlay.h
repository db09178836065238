// SPDX-License-Identifier: GPL-3.0-or-later
// Painted over a trajectory's picture: names, cursor, colour bar, texts.
#pragma once

#include "ui/scene/trajectory_scene.h"
#include "ui/scene/turntable_camera.h"

#include <Eigen/Core>
#include <QSizeF>
#include <QWidget>

#include <array>
#include <optional>

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

// Numbers at the cursor's time, in a row.

class QLabel;

namespace evical::ui {

struct PoseNumbers {
  bool of_camera = false;  // otherwise of the IMU
  std::optional<Eigen::Vector3d> position_m;
  std::optional<double> speed_m_s, rotation_rate_rad_s, residual_px;
};

class PoseReadout : public QWidget {
  Q_OBJECT

 public:
  explicit PoseReadout(QWidget* parent = nullptr);
  void setNumbers(const PoseNumbers& numbers);

 private:
  std::array<QLabel*, 4> captions_{}, values_{};
};

}  // namespace evical::ui
