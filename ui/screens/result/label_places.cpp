// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/result/label_places.h"

namespace evical::ui {
namespace {

double areaOf(const QRectF& place) {
  return place.width() * place.height();
}

}  // namespace

// Area outside counts like overlap with another text.
double LabelPlaces::covered(const QRectF& place) const {
  double sum = areaOf(place) - areaOf(place.intersected(area_));
  for (const QRectF& other : taken_) sum += areaOf(place.intersected(other));
  return sum;
}

QRectF LabelPlaces::place(const QSizeF& size, const std::vector<QPointF>& middles) {
  QRectF best;
  double least = -1.0;
  for (const QPointF& middle : middles) {
    QRectF candidate(QPointF(), size);
    candidate.moveCenter(middle);
    const double covers = covered(candidate);
    if (least >= 0.0 && covers >= least) continue;
    least = covers;
    best = candidate;
    if (least <= 0.0) break;
  }
  occupy(best);
  return best;
}

}  // namespace evical::ui
