// SPDX-License-Identifier: GPL-3.0-or-later
// Chart of the views of a lens: distance and tilt of the board. One dot per view, larger for more points.
#pragma once

#include "core/data/intrinsics_result.h"

#include <QWidget>

#include <vector>

namespace evical::ui {

class ViewsChart : public QWidget {
  Q_OBJECT

 public:
  explicit ViewsChart(QWidget* parent = nullptr);

  void setViews(std::vector<IntrinsicsView> views);
  std::size_t count() const { return views_.size(); }
  QPointF placeOf(std::size_t view) const;
  QString textAt(const QPoint& position) const;  // of the view at this position; empty: none
  QSize minimumSizeHint() const override { return {220, 180}; }

 protected:
  void paintEvent(QPaintEvent*) override;
  bool event(QEvent* event) override;

 private:
  QRectF plotRect() const;
  double radius_px(std::size_t view) const;
  void paintAxes(QPainter& painter) const;

  std::vector<IntrinsicsView> views_;
  double max_m_ = 1.0, max_deg_ = 90.0;  // ends of the axes
  int max_circles_ = 1;
};

}  // namespace evical::ui
