// SPDX-License-Identifier: GPL-3.0-or-later
// Placement of texts in a drawing without overlaps.
#pragma once

#include <QRectF>

#include <vector>

namespace evical::ui {

class LabelPlaces {
 public:
  explicit LabelPlaces(const QRectF& area) : area_(area) {}

  void occupy(const QRectF& place) { taken_.push_back(place); }
  // Around the first of these centres without overlap inside the area; else around the one with the least.
  // Occupies the place.
  QRectF place(const QSizeF& size, const std::vector<QPointF>& middles);

 private:
  double covered(const QRectF& place) const;

  QRectF area_;
  std::vector<QRectF> taken_;
};

}  // namespace evical::ui
