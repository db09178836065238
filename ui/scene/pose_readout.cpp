// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/pose_readout.h"

#include "core/numerics/angles.h"
#include "ui/forms/flow_layout.h"

#include <QHBoxLayout>
#include <QLabel>

#include <cmath>

namespace evical::ui {
namespace {

QString number(const std::optional<double>& value, int decimals, const QString& unit) {
  if (!value || !std::isfinite(*value)) return QStringLiteral("\u2013");
  return QString::number(*value, 'f', decimals) + " " + unit;
}

QString metres(const std::optional<Eigen::Vector3d>& position_m) {
  if (!position_m) return QStringLiteral("\u2013");
  return QString("%1, %2, %3 m")
      .arg(position_m->x(), 0, 'f', 3)
      .arg(position_m->y(), 0, 'f', 3)
      .arg(position_m->z(), 0, 'f', 3);
}

}  // namespace

PoseReadout::PoseReadout(QWidget* parent) : QWidget(parent) {
  auto* const all = new FlowLayout(this);
  all->setContentsMargins(12, 4, 12, 6);
  all->setSpacing(6);
  const std::array<QString, 4> names = {tr("IMU position"), tr("Speed"), tr("Rotation rate"), tr("Residual")};
  const std::array<QString, 4> widest = {"-0.000, -0.000, -0.000 m", "00.00 m/s", "0000.0 \u00b0/s",
                                         "00.000 px"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    auto* const pair = new QWidget(this);  // keeps caption and value together
    auto* const row = new QHBoxLayout(pair);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(6);
    captions_[k] = new QLabel(names[k], pair);
    captions_[k]->setForegroundRole(QPalette::PlaceholderText);
    values_[k] = new QLabel(pair);
    values_[k]->setTextInteractionFlags(Qt::TextSelectableByMouse);
    values_[k]->setMinimumWidth(values_[k]->fontMetrics().horizontalAdvance(widest[k]) + 10);
    row->addWidget(captions_[k]);
    row->addWidget(values_[k]);
    all->addWidget(pair);
  }
  values_[0]->setToolTip(tr("In the board's frame: x along a row, y down the columns, z into the board"));
  values_[3]->setToolTip(tr("RMS over the circles of the board view nearest in time"));
  setNumbers(PoseNumbers{});
}

void PoseReadout::setNumbers(const PoseNumbers& numbers) {
  const std::optional<double> degrees_s =
      numbers.rotation_rate_rad_s ? std::optional(kDegPerRad * *numbers.rotation_rate_rad_s) : std::nullopt;
  captions_[0]->setText(numbers.of_camera ? tr("Camera position") : tr("IMU position"));
  values_[0]->setText(metres(numbers.position_m));
  values_[1]->setText(number(numbers.speed_m_s, 2, "m/s"));
  values_[2]->setText(number(degrees_s, 1, "\u00b0/s"));
  values_[3]->setText(number(numbers.residual_px, 3, "px"));
}

}  // namespace evical::ui
