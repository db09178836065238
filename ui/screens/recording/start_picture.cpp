// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/recording/start_picture.h"

#include "core/geometry/board.h"
#include "ui/theme/theme.h"

#include <QPainter>

#include <algorithm>
#include <vector>

namespace evical::ui {
namespace {

// Centres of the board's circles, with the board's middle at the origin.
std::vector<QPointF> circles(const Board& board) {
  std::vector<QPointF> centres;
  for (const Eigen::Vector2d& centre_m : boardPoints_m(board)) {
    const Eigen::Vector2d from_middle_m = centre_m - 0.5 * board.extent_m();
    centres.emplace_back(from_middle_m.x(), from_middle_m.y());
  }
  return centres;
}

void paintSheet(QPainter& painter, const Board& board, double px_per_m) {
  const Eigen::Vector2d half_m = 0.5 * board.extent_m().array() + 1.6 * board.radius_m;
  painter.setPen(QPen(theme().grid_line, 1.5));
  painter.setBrush(Qt::white);
  painter.drawRect(QRectF(-half_m.x() * px_per_m, -half_m.y() * px_per_m, 2.0 * half_m.x() * px_per_m,
                          2.0 * half_m.y() * px_per_m));
  painter.setPen(Qt::NoPen);
  painter.setBrush(Qt::black);
  for (const QPointF& centre : circles(board))
    painter.drawEllipse(px_per_m * centre, px_per_m * board.radius_m, px_per_m * board.radius_m);
}

// A circle that moves gives events of one polarity ahead and of the other one behind.
void paintEvents(QPainter& painter, const Board& board, double px_per_m) {
  constexpr int kQuarter = 90 * 16;  // Qt's unit of angles is 1/16 degree
  for (const QPointF& centre : circles(board)) {
    QRectF circle(0.0, 0.0, 2.0 * px_per_m * board.radius_m, 2.0 * px_per_m * board.radius_m);
    circle.moveCenter(px_per_m * centre);
    for (const bool ahead : {true, false}) {
      painter.setPen(QPen(ahead ? theme().darker : theme().brighter, 3.0, Qt::DotLine));
      painter.drawArc(circle, (ahead ? -1 : 1) * kQuarter + kQuarter / 8, 2 * kQuarter - kQuarter / 4);
    }
  }
}

}  // namespace

void StartPicture::paintEvent(QPaintEvent*) {
  Board board;
  board.rows = 7;
  board.spacing_m = 0.03;
  board.radius_m = 0.011;
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const Eigen::Vector2d size_m = board.extent_m().array() + 4.0 * board.radius_m;
  painter.translate(rect().center());
  if (shows_ == Shows::Events) painter.rotate(-18.0);
  const double filled = shows_ == Shows::Sheet ? 0.9 : 0.75;  // the rotated board is higher
  const double px_per_m = filled * std::min(width() / size_m.x(), height() / size_m.y());
  shows_ == Shows::Sheet ? paintSheet(painter, board, px_per_m) : paintEvents(painter, board, px_per_m);
}

}  // namespace evical::ui
