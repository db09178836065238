// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers at the cursor's time, in a row.
#pragma once

#include <QWidget>

#include <Eigen/Core>

#include <array>
#include <optional>

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
