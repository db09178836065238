// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/trajectory_overlay.h"

#include "core/numerics/angles.h"
#include "ui/forms/flow_layout.h"
#include "ui/theme/theme.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPainter>
#include <QPainterPath>

#include <cmath>

namespace evical::ui {
namespace {

constexpr double kMargin_px = 12.0;
constexpr double kBarWidth_px = 100.0, kBarHeight_px = 220.0;
constexpr double kCursor_px = 6.0;

// With a halo, for any background.
void paintLabel(QPainter& painter, const QPointF& centre, const QString& text, const QColor& colour) {
  const QFontMetricsF metrics(painter.font());
  QPainterPath path;
  path.addText(centre + QPointF(-0.5 * metrics.horizontalAdvance(text), 0.35 * metrics.ascent()),
               painter.font(), text);
  painter.strokePath(path, QPen(theme().panel, 3.0, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  painter.fillPath(path, colour);
}

void paintCursor(QPainter& painter, const QPointF& at) {
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(theme().panel, 5.0));
  painter.drawEllipse(at, kCursor_px, kCursor_px);
  painter.setPen(QPen(theme().accent, 2.5));
  painter.drawEllipse(at, kCursor_px, kCursor_px);
}

// Top left, one below the other.
void paintLegend(QPainter& painter, const std::vector<LegendEntry>& legend) {
  const QFontMetricsF metrics(painter.font());
  constexpr double kSwatch_px = 10.0, kGap_px = 6.0;
  double y = kMargin_px;
  for (const LegendEntry& entry : legend) {
    const QRectF line(kMargin_px, y, kSwatch_px, metrics.height());
    painter.fillRect(QRectF(line.left(), line.center().y() - 0.5 * kSwatch_px, kSwatch_px, kSwatch_px),
                     entry.colour);
    const double width = metrics.horizontalAdvance(entry.text);
    paintLabel(painter, {line.right() + kGap_px + 0.5 * width, line.center().y()}, entry.text, theme().text);
    y += 1.3 * metrics.height();
  }
}

// Bottom left; cameras and their axes may pass behind it. Without a halo: around so many letters it takes as
// long as the frame.
void paintHint(QPainter& painter, const TrajectoryOverlay& overlay) {
  const QFontMetricsF metrics(painter.font());
  const QRectF line(kMargin_px, overlay.screen.height() - kMargin_px - metrics.height(),
                    metrics.horizontalAdvance(overlay.hint), metrics.height());
  QColor behind = theme().panel;
  behind.setAlphaF(0.85F);
  painter.fillRect(line.adjusted(-3.0, 0.0, 3.0, 0.0), behind);
  painter.setPen(theme().faint_text);
  painter.drawText(line, Qt::AlignLeft | Qt::AlignVCenter, overlay.hint);
}

void paintMessage(QPainter& painter, const TrajectoryOverlay& overlay) {
  const QFontMetricsF metrics(painter.font());
  QRectF box = metrics.boundingRect(QRectF(0.0, 0.0, 0.8 * overlay.screen.width(), overlay.screen.height()),
                                    Qt::TextWordWrap, overlay.message);
  box = box.adjusted(-18.0, -10.0, 18.0, 10.0);
  const double middle = 0.5 * overlay.screen.height();
  const double below = overlay.screen.height() - 4.0 * metrics.height() - box.height();
  box.moveCenter(QPointF(0.5 * overlay.screen.width(), middle));
  if (!overlay.in_middle) box.moveTop(below);
  painter.setPen(QPen(theme().grid_line, 1.0));
  painter.setBrush(theme().window);
  painter.drawRoundedRect(box, 8.0, 8.0);
  painter.setPen(theme().text);
  painter.drawText(box, Qt::AlignCenter | Qt::TextWordWrap, overlay.message);
}

}  // namespace

void paintOverlay(QPainter& painter, const TrajectoryOverlay& overlay) {
  for (const SceneLabel& label : overlay.labels) {
    if (const auto at = overlay.pose.project(label.at_m, overlay.screen)) {
      paintLabel(painter, *at, label.text, label.colour);
    }
  }
  if (overlay.cursor_m) {
    if (const auto at = overlay.pose.project(*overlay.cursor_m, overlay.screen)) paintCursor(painter, *at);
  }
  if (overlay.scale) {
    paintColourBar(
        painter,
        QRectF(overlay.screen.width() - kBarWidth_px - kMargin_px, kMargin_px, kBarWidth_px, kBarHeight_px),
        *overlay.scale);
  }
  paintLegend(painter, overlay.legend);
  paintHint(painter, overlay);
  if (!overlay.message.isEmpty()) paintMessage(painter, overlay);
}

}  // namespace evical::ui

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
  values_[3]->setToolTip(tr("RMS over the points of the board view nearest in time"));
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
