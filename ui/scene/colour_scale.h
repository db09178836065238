// SPDX-License-Identifier: GPL-3.0-or-later
// Mapping of values to colours, and its colour bar.
#pragma once

#include <QColor>
#include <QString>

#include <vector>

class QPainter;
class QRectF;

namespace evical::ui {

struct ColourScale {
  QString title;  // with unit
  double high = 1.0;
  bool dark = false;  // for a dark background

  // Values outside 0 to high are clamped; NaN gets a faint colour that is not part of the scale.
  QColor colourOf(double value) const;
};

// End of a scale from 0: a round number that 98 of 100 values do not exceed; NaN does not count.
double scaleEnd(std::vector<double> values);

void paintColourBar(QPainter& painter, const QRectF& area, const ColourScale& scale);

}  // namespace evical::ui
