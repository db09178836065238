// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/board_drawing.h"

#include "core/base/error.h"
#include "ui/theme/theme.h"

#include <QPainter>

#include <algorithm>
#include <optional>

namespace evical::ui {
namespace {

constexpr double kMargin_px = 34.0;  // for axes and measures

std::optional<QString> problemOf(const CircleBoard& board) {
  try {
    validate(board);
    return std::nullopt;
  } catch (const CalibrationError& error) {
    return QString::fromStdString(error.problem());
  }
}

QString millimetres(double length_m) {
  return QObject::tr("%1 mm").arg(1e3 * length_m, 0, 'g', 4);
}

}  // namespace

BoardDrawing::BoardDrawing(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setBoard({});
}

void BoardDrawing::setBoard(const CircleBoard& board) {
  board_ = board;
  setAccessibleName(tr("Board with %1 circles").arg(board.circleCount()));
  update();
}

void BoardDrawing::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(theme().faint_text);
  if (const std::optional<QString> problem = problemOf(board_)) {
    painter.drawText(rect().adjusted(12, 12, -12, -12), Qt::AlignCenter | Qt::TextWordWrap, *problem);
    return;
  }
  // The board's long side lies along the drawing's: x of the board points down then, as on a turned sheet.
  const int columns = board_.type == BoardType::AsymmetricCircles ? 2 * board_.cols - 1 : board_.cols - 1;
  const double width_m = columns * board_.spacing_m + 2.0 * board_.radius_m;
  const double height_m = (board_.rows - 1) * board_.spacing_m + 2.0 * board_.radius_m;
  const double px_per_m =
      std::min((width() - 2.0 * kMargin_px) / width_m, (height() - 2.0 * kMargin_px) / height_m);
  const QPointF origin(0.5 * (width() - width_m * px_per_m) + board_.radius_m * px_per_m,
                       0.5 * (height() - height_m * px_per_m) + board_.radius_m * px_per_m);
  const double edge_px = (board_.radius_m + 0.3 * board_.spacing_m) * px_per_m;
  painter.setPen(QPen(theme().grid_line, 1.0));
  painter.setBrush(board_.circles == CircleShade::Dark ? QColor(Qt::white) : QColor(0x22, 0x22, 0x22));
  const QSizeF sheet((width_m - 2.0 * board_.radius_m) * px_per_m,
                     (height_m - 2.0 * board_.radius_m) * px_per_m);
  painter.drawRoundedRect(QRectF(origin, sheet).adjusted(-edge_px, -edge_px, edge_px, edge_px), 4.0, 4.0);
  paintCircles(painter, px_per_m, origin);
  paintMeasures(painter, px_per_m, origin);
}

void BoardDrawing::paintCircles(QPainter& painter, double px_per_m, QPointF origin) const {
  painter.setPen(Qt::NoPen);
  painter.setBrush(board_.circles == CircleShade::Dark ? QColor(0x22, 0x22, 0x22) : QColor(Qt::white));
  const double radius_px = board_.radius_m * px_per_m;
  for (int i = 0; i < board_.circleCount(); ++i) {
    const Eigen::Vector2d centre_m = board_.centre_m(i);
    painter.drawEllipse(origin + px_per_m * QPointF(centre_m.x(), centre_m.y()), radius_px, radius_px);
  }
}

void BoardDrawing::paintMeasures(QPainter& painter, double px_per_m, QPointF origin) const {
  constexpr double kAxis_px = 26.0;
  painter.setPen(QPen(theme().axes[0], 2.0));
  painter.drawLine(origin, origin + QPointF(kAxis_px, 0.0));
  painter.setPen(QPen(theme().axes[1], 2.0));
  painter.drawLine(origin, origin + QPointF(0.0, kAxis_px));

  const Eigen::Vector2d last_m = board_.centre_m(board_.rows - 1, board_.cols - 1);
  const Eigen::Vector2d neighbour_m = board_.centre_m(0, 1);
  const double edge_px = (board_.radius_m + 0.3 * board_.spacing_m) * px_per_m;
  painter.setPen(QPen(theme().accent, 1.5));
  const double above_px = origin.y() - edge_px - 6.0;
  const QPointF begin(origin.x(), above_px), end(origin.x() + px_per_m * neighbour_m.x(), above_px);
  painter.drawLine(begin, end);
  for (const QPointF& tick : {begin, end}) painter.drawLine(tick - QPointF(0, 3), tick + QPointF(0, 3));
  painter.drawText(QPointF(begin.x(), above_px - 7.0), millimetres(neighbour_m.x()));

  painter.setPen(theme().faint_text);
  const double below_px = origin.y() + px_per_m * last_m.y() + edge_px + 4.0;
  painter.drawText(
      QRectF(0.0, below_px, width(), kMargin_px), Qt::AlignHCenter | Qt::AlignTop,
      tr("%1 circles, diameter %2").arg(board_.circleCount()).arg(millimetres(2.0 * board_.radius_m)));
}

}  // namespace evical::ui
