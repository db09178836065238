// SPDX-License-Identifier: GPL-3.0-or-later
// Drawing of the board to scale, with dimensions, for comparison with the print.
#pragma once

#include "core/geometry/board.h"
#include "core/geometry/printed_pattern.h"

#include <QString>
#include <QWidget>

#include <vector>

namespace evical::ui {

class BoardDrawing : public QWidget {
  Q_OBJECT

 public:
  explicit BoardDrawing(QWidget* parent = nullptr);

  void setBoard(const Board& board);
  QSize minimumSizeHint() const override { return {140, 120}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void paintPattern(QPainter& painter, double px_per_m, QPointF origin) const;
  void paintMeasures(QPainter& painter, double px_per_m, QPointF origin) const;

  Board board_;
  std::vector<PaintedBox> squares_;  // for boards without circles
  QString problem_;                  // reason why it cannot be drawn; empty: it can
};

}  // namespace evical::ui
