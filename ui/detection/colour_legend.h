// SPDX-License-Identifier: GPL-3.0-or-later
// What the colours of the event view mean, in the picture's corner.
#pragma once

#include <QRect>

class QPainter;

namespace evical::ui {

enum class ColourLegend {
  None,       // of a photograph alone
  Polarity,   // events: which brighten, which darken
  Direction,  // normal flow: a wheel of the directions
};

// In the lower right corner of `room`; nothing where it would fill the picture.
void paintLegend(QPainter& painter, const QRect& room, ColourLegend legend);

}  // namespace evical::ui
