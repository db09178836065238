// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of everything that is drawn by hand: plots, event view, timeline,
// 3D scene. Widgets follow QPalette.
#pragma once

#include <QColor>
#include <QIcon>
#include <QPalette>
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

// Between two colours; `share_of_b` from 0 to 1.
inline QColor mixed(const QColor& a, const QColor& b, double share_of_b) {
  const auto mix = [&](int from, int to) { return static_cast<int>(from + share_of_b * (to - from)); };
  return {mix(a.red(), b.red()), mix(a.green(), b.green()), mix(a.blue(), b.blue())};
}

const Theme& theme();  // of the palette that is set; GUI thread only

// Fusion style, palette, style sheet and font. May be called again to switch.
void applyTheme(QApplication& application, Appearance appearance);

// Whether the desktop wants things to move: people who get dizzy turn animations off.
bool desktopAnimates();

// One of the icons in resources/icons (SVG, by file name without ending), tinted
// with the palette's text colour.
QIcon icon(const QString& name);
// The same in a colour of its own, for states: good, warning, bad.
QIcon icon(const QString& name, const QColor& colour);
QIcon icon(const QString& name, QPalette::ColorRole role);

}  // namespace evical::ui
