// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/trajectory_overlay.h"

#include "ui/theme/theme.h"

#include <QPainter>
#include <QPainterPath>

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
