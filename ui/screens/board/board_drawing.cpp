// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/board/board_drawing.h"

#include "core/base/error.h"
#include "ui/theme/theme.h"

#include <QPainter>

#include <algorithm>

namespace evical::ui {
namespace {

constexpr double kMeasureMargin_px = 34.0;  // for axes and dimensions
constexpr QColor kInk(0x22, 0x22, 0x22);

// Checkerboards and tags have dark squares on bright paper, regardless of the circles' shade.
QColor paperOf(const Board& board) {
  return board.hasCircles() && board.circles == CircleShade::Bright ? kInk : QColor(Qt::white);
}

// Distance from the outermost points to the sheet's edge.
double sheetBeyond_m(const Board& board) {
  constexpr double kRim = 0.3;  // of the spacing
  return board.printBeyond_m() + kRim * board.spacing_m;
}

QString boardMillimetres(double length_m) {
  return QObject::tr("%1 mm").arg(1e3 * length_m, 0, 'g', 4);
}

}  // namespace

BoardDrawing::BoardDrawing(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setBoard({});
}

void BoardDrawing::setBoard(const Board& board) {
  board_ = board;
  squares_.clear();
  problem_.clear();
  try {
    validate(board_);
    squares_ = boardSquares(board_, {});
  } catch (const CalibrationError& error) {
    problem_ = QString::fromStdString(error.problem());
  }
  setAccessibleName(tr("Board with %1 points").arg(board.pointCount()));
  update();
}

void BoardDrawing::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(theme().faint_text);
  if (!problem_.isEmpty()) {
    painter.drawText(rect().adjusted(12, 12, -12, -12), Qt::AlignCenter | Qt::TextWordWrap, problem_);
    return;
  }
  // Long side along the drawing's: the board's x axis then points down, as on a rotated sheet.
  const Eigen::Vector2d extent_m = board_.extent_m();
  const double around_m = sheetBeyond_m(board_);
  const double width_m = extent_m.x() + 2.0 * around_m, height_m = extent_m.y() + 2.0 * around_m;
  const double px_per_m = std::min((width() - 2.0 * kMeasureMargin_px) / width_m,
                                   (height() - 2.0 * kMeasureMargin_px) / height_m);
  const QPointF corner(0.5 * (width() - width_m * px_per_m) + around_m * px_per_m,
                       0.5 * (height() - height_m * px_per_m) + around_m * px_per_m);
  const QPointF origin = corner - px_per_m * QPointF(board_.corner_m().x(), board_.corner_m().y());
  const double edge_px = around_m * px_per_m;
  painter.setPen(QPen(theme().grid_line, 1.0));
  painter.setBrush(paperOf(board_));
  const QSizeF sheet(extent_m.x() * px_per_m, extent_m.y() * px_per_m);
  painter.drawRoundedRect(QRectF(corner, sheet).adjusted(-edge_px, -edge_px, edge_px, edge_px), 4.0, 4.0);
  paintPattern(painter, px_per_m, origin);
  paintMeasures(painter, px_per_m, origin);
}

void BoardDrawing::paintPattern(QPainter& painter, double px_per_m, QPointF origin) const {
  painter.setPen(Qt::NoPen);
  for (const PaintedBox& square : squares_) {
    painter.setBrush(square.bright ? QColor(Qt::white) : kInk);
    painter.drawRect(QRectF(origin + px_per_m * QPointF(square.corner_m.x(), square.corner_m.y()),
                            px_per_m * QSizeF(square.size_m.x(), square.size_m.y())));
  }
  if (!board_.hasCircles()) return;
  painter.setBrush(board_.circles == CircleShade::Dark ? kInk : QColor(Qt::white));
  const double radius_px = board_.radius_m * px_per_m;
  for (int i = 0; i < board_.pointCount(); ++i) {
    const Eigen::Vector2d centre_m = board_.point_m(i);
    painter.drawEllipse(origin + px_per_m * QPointF(centre_m.x(), centre_m.y()), radius_px, radius_px);
  }
}

void BoardDrawing::paintMeasures(QPainter& painter, double px_per_m, QPointF origin) const {
  constexpr double kAxis_px = 26.0;
  painter.setPen(QPen(theme().axes[0], 2.0));
  painter.drawLine(origin, origin + QPointF(kAxis_px, 0.0));
  painter.setPen(QPen(theme().axes[1], 2.0));
  painter.drawLine(origin, origin + QPointF(0.0, kAxis_px));

  const Eigen::Vector2d first_m = board_.corner_m(), last_m = first_m + board_.extent_m();
  const Eigen::Vector2d neighbour_m = board_.point_m(0, 1);
  const double edge_px = sheetBeyond_m(board_) * px_per_m;
  painter.setPen(QPen(theme().accent, 1.5));
  const double above_px = origin.y() + px_per_m * first_m.y() - edge_px - 6.0;
  const double begin_px = origin.x() + px_per_m * first_m.x();
  const QPointF begin(begin_px, above_px), end(begin_px + px_per_m * neighbour_m.x(), above_px);
  painter.drawLine(begin, end);
  for (const QPointF& tick : {begin, end}) painter.drawLine(tick - QPointF(0, 3), tick + QPointF(0, 3));
  // Same number as in the form: an asymmetric grid's spacing is between rows; neighbours in a row are two
  // spacings apart.
  const bool two = board_.type == BoardType::AsymmetricCircles;
  painter.drawText(
      QPointF(begin.x(), above_px - 7.0),
      two ? tr("2 x %1").arg(boardMillimetres(board_.spacing_m)) : boardMillimetres(neighbour_m.x()));

  painter.setPen(theme().faint_text);
  const double below_px = origin.y() + px_per_m * last_m.y() + edge_px + 4.0;
  painter.drawText(
      QRectF(0.0, below_px, width(), kMeasureMargin_px), Qt::AlignHCenter | Qt::AlignTop | Qt::TextWordWrap,
      board_.hasCircles() ? tr("%1 circles, diameter %2")
                                .arg(board_.pointCount())
                                .arg(boardMillimetres(2.0 * board_.radius_m))
      : board_.type == BoardType::AprilGrid
          ? tr("%1 tags of %2").arg(board_.rows * board_.cols).arg(boardMillimetres(board_.tag_size_m))
      : board_.hasPattern() ? tr("%1 inner corners").arg(board_.pointCount())
                            : tr("%1 points").arg(board_.pointCount()));
}

}  // namespace evical::ui
