// SPDX-License-Identifier: GPL-3.0-or-later
// Where texts of a drawing find room, none over another.
#pragma once

#include <QRectF>

#include <vector>

namespace evical::ui {

class LabelPlaces {
 public:
  explicit LabelPlaces(const QRectF& area) : area_(area) {}

  void occupy(const QRectF& place) { taken_.push_back(place); }
  // About the first of these middles where it covers nothing and is all inside; else where it covers least. Occupied
  // from then on.
  QRectF place(const QSizeF& size, const std::vector<QPointF>& middles);

 private:
  double covered(const QRectF& place) const;

  QRectF area_;
  std::vector<QRectF> taken_;
};

}  // namespace evical::ui
