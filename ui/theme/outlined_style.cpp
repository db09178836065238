// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/theme/outlined_style.h"

#include "ui/theme/theme.h"

#include <QPainter>
#include <QStyleFactory>
#include <QStyleOption>

namespace evical::ui {
namespace {

void drawOutline(const QStyleOption& option, QPainter& painter) {
  constexpr double kRadius_px = 2.0;
  constexpr float kFaint = 0.55f;
  QColor colour = theme().faint_text;
  const bool active = option.state.testFlag(QStyle::State_Enabled);
  colour.setAlphaF(active ? kFaint : 0.5f * kFaint);
  if (active && option.state.testFlag(QStyle::State_HasFocus)) colour = theme().accent;
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(colour, 1.0));
  painter.setBrush(Qt::NoBrush);
  painter.drawRoundedRect(QRectF(option.rect).adjusted(0.5, 0.5, -0.5, -0.5), kRadius_px, kRadius_px);
  painter.restore();
}

}  // namespace

OutlinedStyle::OutlinedStyle() : QProxyStyle(QStyleFactory::create("Fusion")) {}

void OutlinedStyle::drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                                  const QWidget* widget) const {
  if (element == PE_FrameTabBarBase) return;  // a line above widgets next to the tabs
  QProxyStyle::drawPrimitive(element, option, painter, widget);
  if (theme().dark && (element == PE_IndicatorCheckBox || element == PE_FrameLineEdit))
    drawOutline(*option, *painter);
}

void OutlinedStyle::drawComplexControl(ComplexControl control, const QStyleOptionComplex* option,
                                       QPainter* painter, const QWidget* widget) const {
  QProxyStyle::drawComplexControl(control, option, painter, widget);
  if (theme().dark && control == CC_SpinBox) drawOutline(*option, *painter);
}

}  // namespace evical::ui
