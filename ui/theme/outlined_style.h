// SPDX-License-Identifier: GPL-3.0-or-later
// Fusion style with outlines that are visible in dark themes, where its own are darker than the window.
#pragma once

#include <QProxyStyle>

namespace evical::ui {

class OutlinedStyle final : public QProxyStyle {
 public:
  OutlinedStyle();

  void drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                     const QWidget* widget) const override;
  void drawComplexControl(ComplexControl control, const QStyleOptionComplex* option, QPainter* painter,
                          const QWidget* widget) const override;
};

}  // namespace evical::ui
