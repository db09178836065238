// SPDX-License-Identifier: GPL-3.0-or-later
// Values as colours, and the bar that explains them.
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

  // 0 to high, what lies beyond is clamped; of no number, a faint colour that is not on the scale.
  QColor colourOf(double value) const;
};

// From 0 to a round number that 98 of 100 values do not exceed; values that are no number do not count.
double scaleEnd(std::vector<double> values);

void paintColourBar(QPainter& painter, const QRectF& area, const ColourScale& scale);

}  // namespace evical::ui
