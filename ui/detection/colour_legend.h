// SPDX-License-Identifier: GPL-3.0-or-later
// Legend of the event view's colours, in a corner of the picture.
#pragma once

#include <QRect>

class QPainter;

namespace evical::ui {

enum class ColourLegend {
  None,       // frame without events
  Polarity,   // events: brighter and darker
  Direction,  // normal flow: a wheel of the directions
};

// In the lower right corner of `room`; nothing if it would fill the picture.
void paintLegend(QPainter& painter, const QRect& room, ColourLegend legend);

}  // namespace evical::ui
