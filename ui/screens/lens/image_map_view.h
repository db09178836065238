// SPDX-License-Identifier: GPL-3.0-or-later
// Map of one number per cell of a camera's image, as colours with a scale below.
#pragma once

#include "core/geometry/resolution.h"

#include <QString>
#include <QWidget>

#include <optional>
#include <vector>

namespace evical::ui {

struct ImageMapCells {
  int columns = 0, rows = 0;
  Resolution resolution_px;
  std::vector<std::optional<double>> values;  // row by row; none: hatched
  QString unit;
  bool more_is_better = false;  // for the colours: true for counts, false for errors
};

class ImageMapView : public QWidget {
  Q_OBJECT

 public:
  explicit ImageMapView(QWidget* parent = nullptr);

  void setCells(ImageMapCells cells);
  const ImageMapCells& cells() const { return cells_; }
  QString textAt(const QPoint& position) const;  // "x 120 px, y 40 px: 0.031 px"; empty outside the image
  QRectF imageRect() const;
  QSize minimumSizeHint() const override { return {220, 200}; }

 protected:
  void paintEvent(QPaintEvent*) override;
  bool event(QEvent* event) override;

 private:
  QColor colourOf(double value) const;
  QString textOf(double value) const;
  void paintScale(QPainter& painter) const;

  ImageMapCells cells_;
  double max_ = 1.0;  // end of the scale
};

}  // namespace evical::ui
