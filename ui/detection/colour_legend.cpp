// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/colour_legend.h"

#include "ui/detection/surface_frame.h"
#include "ui/theme/theme.h"

#include <QConicalGradient>
#include <QCoreApplication>
#include <QPainter>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace evical::ui {
namespace {

constexpr int kInside_px = 6, kPadding_px = 8;

QString words(const char* text) {
  return QCoreApplication::translate("ColourLegend", text);
}

QRect paintBox(QPainter& painter, const QRect& room, QSize size) {
  const QRect box(room.bottomRight() - QPoint(size.width() + kInside_px, size.height() + kInside_px), size);
  QColor background = theme().window;
  background.setAlphaF(0.85f);
  painter.setPen(Qt::NoPen);
  painter.setBrush(background);
  painter.drawRoundedRect(box, 4, 4);
  return box.adjusted(kPadding_px, 0, -kPadding_px, 0);
}

void paintPolarity(QPainter& painter, const QRect& room) {
  constexpr int kSquare_px = 10, kGap_px = 6;
  const QFontMetrics metrics = painter.fontMetrics();
  const std::array entries = {std::pair(words("brighter"), theme().brighter),
                              std::pair(words("darker"), theme().darker)};
  int width = 2 * kPadding_px;
  for (const auto& [text, colour] : entries)
    width += kSquare_px + kGap_px + metrics.horizontalAdvance(text) + kPadding_px;
  const QRect box = paintBox(painter, room, {width - kPadding_px, metrics.height() + 8});
  int x = box.left();
  for (const auto& [text, colour] : entries) {
    painter.setPen(Qt::NoPen);
    painter.setBrush(colour);
    painter.drawRoundedRect(QRect(x, box.center().y() - kSquare_px / 2, kSquare_px, kSquare_px), 2, 2);
    x += kSquare_px + kGap_px;
    painter.setPen(theme().text);
    const int text_px = metrics.horizontalAdvance(text);
    painter.drawText(QRect(x, box.top(), text_px + 2, box.height()), Qt::AlignVCenter | Qt::AlignLeft, text);
    x += text_px + kPadding_px;
  }
}

void paintDirections(QPainter& painter, const QRect& room) {
  constexpr int kWheel_px = 40;
  const QString text = words("edges move");
  const int text_px = painter.fontMetrics().horizontalAdvance(text);
  const QRect box =
      paintBox(painter, room, {2 * kPadding_px + text_px + kPadding_px + kWheel_px, kWheel_px + 10});
  const QRectF wheel(box.right() - kWheel_px + 1, box.center().y() - kWheel_px / 2 + 1, kWheel_px, kWheel_px);
  QConicalGradient colours(wheel.center(), 0.0);
  constexpr int kStops = 24;
  for (int k = 0; k <= kStops; ++k) {
    const double turn = static_cast<double>(k) / kStops, angle_rad = 2.0 * std::numbers::pi * turn;
    colours.setColorAt(turn, QColor(flowColour(std::cos(angle_rad), -std::sin(angle_rad))));  // y points down
  }
  painter.setPen(Qt::NoPen);
  painter.setBrush(colours);
  painter.drawEllipse(wheel);
  painter.setBrush(theme().window);
  painter.drawEllipse(wheel.adjusted(11, 11, -11, -11));
  painter.setPen(QPen(theme().text, 1.5));
  for (int k = 0; k < 4; ++k) {  // outwards, in the direction of motion
    painter.save();
    painter.translate(wheel.center());
    painter.rotate(90.0 * k);
    painter.drawLine(QPointF(0.0, 0.0), QPointF(7.0, 0.0));
    painter.drawLine(QPointF(7.0, 0.0), QPointF(4.5, -2.0));
    painter.drawLine(QPointF(7.0, 0.0), QPointF(4.5, 2.0));
    painter.restore();
  }
  painter.drawText(QRect(box.left(), box.top(), text_px + 2, box.height()), Qt::AlignVCenter, text);
}

}  // namespace

void paintLegend(QPainter& painter, const QRect& room, ColourLegend legend) {
  constexpr int kMinWidth_px = 280, kMinHeight_px = 160;
  if (legend == ColourLegend::None || room.width() < kMinWidth_px || room.height() < kMinHeight_px) return;
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  if (legend == ColourLegend::Polarity)
    paintPolarity(painter, room);
  else
    paintDirections(painter, room);
  painter.restore();
}

}  // namespace evical::ui
