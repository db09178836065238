// SPDX-License-Identifier: GPL-3.0-or-later
// Mouse and readout of a chart.
#include "ui/plots/plot_chart.h"

#include <algorithm>
#include <cmath>

namespace evical::ui {
namespace {

constexpr double kGrab_px = 6.0;   // distance at which the mouse grabs a line
constexpr double kClick_px = 4.0;  // movement up to which a press and release are a click

}  // namespace

bool PlotChart::overThreshold(const QPointF& pixel) const {
  return threshold_->visible() && axisRect()->rect().contains(pixel.toPoint()) &&
         std::abs(yAxis->coordToPixel(threshold_->point1->coords().y()) - pixel.y()) < kGrab_px;
}

void PlotChart::mousePressEvent(QMouseEvent* event) {
  pressed_at_ = event->position();
  const bool left = event->button() == Qt::LeftButton;
  dragging_threshold_ = left && overThreshold(event->position());
  if (dragging_threshold_) return;
  hideReadout();
  setSelectionRectMode(left && event->modifiers().testFlag(Qt::ShiftModifier) ? QCP::srmZoom : QCP::srmNone);
  QCustomPlot::mousePressEvent(event);
}

void PlotChart::mouseMoveEvent(QMouseEvent* event) {
  if (dragging_threshold_) {
    const QRect area = axisRect()->rect();
    const double y =
        yAxis->pixelToCoord(std::clamp(event->position().y(), 1.0 * area.top(), 1.0 * area.bottom()));
    setThreshold(y);
    emit thresholdDragged(y);
    return;
  }
  QCustomPlot::mouseMoveEvent(event);
  if (event->buttons() != Qt::NoButton) return;
  QWidget::setCursor(overThreshold(event->position()) ? Qt::SplitVCursor : Qt::ArrowCursor);
  showReadout(event->position());
}

void PlotChart::mouseReleaseEvent(QMouseEvent* event) {
  if (dragging_threshold_) {
    dragging_threshold_ = false;
    return;
  }
  QCustomPlot::mouseReleaseEvent(event);
  const QPointF moved = event->position() - pressed_at_;
  if (event->button() != Qt::LeftButton || event->modifiers() != Qt::NoModifier) return;
  if (std::hypot(moved.x(), moved.y()) > kClick_px) return;
  if (!axisRect()->rect().contains(event->position().toPoint())) return;
  emit clicked(xAxis->pixelToCoord(event->position().x()), yAxis->pixelToCoord(event->position().y()));
}

void PlotChart::mouseDoubleClickEvent(QMouseEvent* event) {
  QCustomPlot::mouseDoubleClickEvent(event);
  pressed_at_ = QPointF(-1e6, -1e6);  // its release is not a click
  fit();
}

void PlotChart::wheelEvent(QWheelEvent* event) {
  const bool only_y = event->modifiers().testFlag(Qt::ControlModifier);
  axisRect()->setRangeZoom(only_y       ? Qt::Orientations(Qt::Vertical)
                           : axes_.time ? Qt::Orientations(Qt::Horizontal)
                                        : Qt::Horizontal | Qt::Vertical);
  hideReadout();
  QCustomPlot::wheelEvent(event);
}

void PlotChart::leaveEvent(QEvent* event) {
  hideReadout();
  QCustomPlot::leaveEvent(event);
}

void PlotChart::zoomX(double factor) {
  xAxis->scaleRange(factor);
  replot(rpQueuedReplot);
}

void PlotChart::panX(double share) {
  xAxis->moveRange(share * xAxis->range().size());
  replot(rpQueuedReplot);
}

void PlotChart::toggle(QCPAbstractLegendItem* item) {
  auto* const entry = qobject_cast<QCPPlottableLegendItem*>(item);
  if (!entry) return;
  const bool visible = !entry->plottable()->visible();
  const auto owner = std::find_if(series.begin(), series.end(), [&](const SeriesItems& items) {
    return items.plottable == entry->plottable();
  });
  for (SeriesItems& items : series) {  // items of the same colour belong to it
    if (items.style.colour == owner->style.colour) items.plottable->setVisible(visible);
  }
  QFont font = entry->font();
  font.setStrikeOut(!visible);
  entry->setFont(font);
  replot(rpQueuedReplot);
}

void PlotChart::hideReadout() {
  if (!readout_->visible()) return;
  readout_->setVisible(false);
  hover_->setVisible(false);
  layer("overlay")->replot();
}

void PlotChart::showReadout(const QPointF& pixel) {
  const QRect area = axisRect()->rect();
  if (!area.contains(pixel.toPoint())) return hideReadout();
  const double x = xAxis->pixelToCoord(pixel.x()), y = yAxis->pixelToCoord(pixel.y());
  const bool right_half = pixel.x() > area.center().x(), low_half = pixel.y() > area.center().y();
  readout_->setText(readoutAt(x, y));
  readout_->setPositionAlignment((right_half ? Qt::AlignRight : Qt::AlignLeft) |
                                 (low_half ? Qt::AlignBottom : Qt::AlignTop));
  readout_->position->setCoords(pixel + QPointF(right_half ? -12 : 12, low_half ? -10 : 10));
  readout_->setVisible(true);
  hover_->point1->setCoords(x, 0.0);
  hover_->point2->setCoords(x, 1.0);
  hover_->setVisible(axes_.time);
  layer("overlay")->replot();
}

QString PlotChart::readoutAt(double x, double y) const {
  const int decimals = std::clamp(static_cast<int>(std::ceil(2.0 - std::log10(xAxis->range().size()))), 0, 9);
  QStringList lines = {
      QStringLiteral("%1: %2").arg(axes_.x_label).arg(x, 0, 'f', axes_.whole_x ? 0 : decimals)};
  for (const SeriesItems& items : series) {
    if (items.style.name.isEmpty() || !items.plottable->visible()) continue;
    const QCPPlottableInterface1D* points = nullptr;
    if (items.kind == PlotPanel::SeriesKind::Line || items.kind == PlotPanel::SeriesKind::Bars)
      points = items.plottable->interface1D();
    if (!points || points->dataCount() == 0) continue;
    int nearest = std::min(points->findBegin(x), points->dataCount() - 1);
    if (nearest + 1 < points->dataCount() &&
        std::abs(points->dataMainKey(nearest + 1) - x) < std::abs(points->dataMainKey(nearest) - x))
      ++nearest;
    lines << QStringLiteral("%1: %2").arg(items.style.name).arg(points->dataMainValue(nearest), 0, 'g', 4);
  }
  if (lines.size() == 1) lines << QStringLiteral("%1: %2").arg(yAxis->label()).arg(y, 0, 'g', 4);
  return lines.join('\n');
}

}  // namespace evical::ui
