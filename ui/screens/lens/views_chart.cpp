// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/lens/views_chart.h"

#include "ui/theme/theme.h"

#include <QHelpEvent>
#include <QPainter>
#include <QToolTip>

#include <algorithm>
#include <cmath>

namespace evical::ui {
namespace {

// 1, 2 or 5 times a power of ten, so that four to ten steps reach `most`.
double stepOf(double most) {
  const double power = std::pow(10.0, std::floor(std::log10(most)) - 1.0);
  for (const double step : {1.0, 2.0, 5.0, 10.0, 20.0})
    if (most / (step * power) <= 6.0) return step * power;
  return most;
}

}  // namespace

ViewsChart::ViewsChart(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

void ViewsChart::setViews(std::vector<IntrinsicsView> views) {
  views_ = std::move(views);
  double far_m = 0.1, tilt_deg = 10.0;
  max_circles_ = 1;
  for (const IntrinsicsView& view : views_) {
    far_m = std::max(far_m, view.distance_m);
    tilt_deg = std::max(tilt_deg, view.tilt_deg);
    max_circles_ = std::max(max_circles_, view.circles);
  }
  max_m_ = stepOf(far_m) * std::ceil(1.02 * far_m / stepOf(far_m));
  max_deg_ = 10.0 * std::ceil(1.02 * tilt_deg / 10.0);
  update();
}

QRectF ViewsChart::plotRect() const {
  const QFontMetrics metrics(font());
  return QRectF(rect()).adjusted(metrics.horizontalAdvance("90") + 14.0, metrics.height() + 8.0, -12.0,
                                 -2.0 * metrics.height() - 8.0);
}

QPointF ViewsChart::placeOf(std::size_t view) const {
  const QRectF plot = plotRect();
  return {plot.left() + plot.width() * views_[view].distance_m / max_m_,
          plot.bottom() - plot.height() * views_[view].tilt_deg / max_deg_};
}

double ViewsChart::radius_px(std::size_t view) const {
  return 3.0 + 3.0 * views_[view].circles / max_circles_;
}

void ViewsChart::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  paintAxes(painter);
  painter.setRenderHint(QPainter::Antialiasing);
  QColor fill = theme().accent;
  fill.setAlpha(110);
  painter.setPen(QPen(theme().accent, 1.2));
  painter.setBrush(fill);
  for (std::size_t k = 0; k < views_.size(); ++k) painter.drawEllipse(placeOf(k), radius_px(k), radius_px(k));
}

void ViewsChart::paintAxes(QPainter& painter) const {
  const QRectF plot = plotRect();
  const double line_px = QFontMetrics(font()).height();
  const double step_m = stepOf(max_m_), step_deg = max_deg_ > 50.0 ? 20.0 : 10.0;
  for (double at_m = 0.0; at_m < max_m_ + 0.5 * step_m; at_m += step_m) {
    const double x = plot.left() + plot.width() * at_m / max_m_;
    painter.setPen(theme().grid_line);
    painter.drawLine(QPointF(x, plot.top()), QPointF(x, plot.bottom()));
    painter.setPen(theme().faint_text);
    painter.drawText(QRectF(x - 40.0, plot.bottom() + 2.0, 80.0, line_px), Qt::AlignCenter,
                     QString::number(at_m, 'g', 3));
  }
  for (double at_deg = 0.0; at_deg < max_deg_ + 0.5 * step_deg; at_deg += step_deg) {
    const double y = plot.bottom() - plot.height() * at_deg / max_deg_;
    painter.setPen(theme().grid_line);
    painter.drawLine(QPointF(plot.left(), y), QPointF(plot.right(), y));
    painter.setPen(theme().faint_text);
    painter.drawText(QRectF(0.0, y - 0.5 * line_px, plot.left() - 6.0, line_px),
                     Qt::AlignRight | Qt::AlignVCenter, QString::number(at_deg, 'f', 0));
  }
  painter.drawText(QRectF(0.0, 2.0, width(), line_px), Qt::AlignLeft, tr("tilt of the board [deg]"));
  painter.drawText(QRectF(0.0, height() - line_px - 2.0, plot.right(), line_px), Qt::AlignRight,
                   tr("distance [m]"));
}

QString ViewsChart::textAt(const QPoint& position) const {
  for (std::size_t k = 0; k < views_.size(); ++k) {
    const QPointF off = placeOf(k) - position;
    if (std::hypot(off.x(), off.y()) > radius_px(k) + 2.0) continue;
    const IntrinsicsView& view = views_[k];
    return tr("at %1 s: %2 m away, tilted by %3 deg, %4 points, %5 px RMS")
        .arg(view.time_s, 0, 'f', 2)
        .arg(view.distance_m, 0, 'f', 2)
        .arg(view.tilt_deg, 0, 'f', 0)
        .arg(view.circles)
        .arg(view.reprojection_rms_px, 0, 'g', 2);
  }
  return {};
}

bool ViewsChart::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto* const help = static_cast<QHelpEvent*>(event);
  QToolTip::showText(help->globalPos(), textAt(help->pos()), this);
  return true;
}

}  // namespace evical::ui
