// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of everything that is painted: plots, event view, timeline, 3D scene. Widgets follow QPalette.
#pragma once

#include <QColor>
#include <QIcon>
#include <QPalette>
#include <QProxyStyle>
#include <QString>

#include <array>

class QApplication;

namespace evical::ui {

enum class Appearance { System, Light, Dark };

struct Theme {
  bool dark = false;
  QColor window, panel, text, faint_text, grid_line, accent;
  QColor good, warning, bad;     // complete / partial / missed; ok / doubtful / failed
  QColor brighter, darker;       // polarity of events
  std::array<QColor, 3> axes;    // x, y, z
  std::array<QColor, 8> series;  // curves, in order
};

// Mixture of two colours; `share_of_b` from 0 to 1.
inline QColor mixed(const QColor& a, const QColor& b, double share_of_b) {
  const auto mix = [&](int from, int to) { return static_cast<int>(from + share_of_b * (to - from)); };
  return {mix(a.red(), b.red()), mix(a.green(), b.green()), mix(a.blue(), b.blue())};
}

const Theme& theme();  // theme of the current palette; GUI thread only

// Fusion style, palette, style sheet and font. May be called again to switch.
void applyTheme(QApplication& application, Appearance appearance);

// True if the desktop's animations are enabled: people who get dizzy disable them.
bool desktopAnimates();

// An icon of resources/icons (SVG, by file name without extension), tinted with the palette's text colour.
QIcon icon(const QString& name);
// The same in a given colour, for states: good, warning, bad.
QIcon icon(const QString& name, const QColor& colour);
QIcon icon(const QString& name, QPalette::ColorRole role);

// Fusion style with outlines that are visible in dark themes, where its own are darker than the window.
class OutlinedStyle final : public QProxyStyle {
 public:
  OutlinedStyle();

  void drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                     const QWidget* widget) const override;
  void drawComplexControl(ComplexControl control, const QStyleOptionComplex* option, QPainter* painter,
                          const QWidget* widget) const override;
};

// A few rules that modernise Fusion. Everything else follows the palette.

// Frames with the property `card` are panels, labels with the property `role` are titles, hints or problems.
QString styleSheetOf(const Theme& theme);

}  // namespace evical::ui
