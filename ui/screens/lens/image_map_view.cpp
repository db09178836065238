// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/lens/image_map_view.h"

#include "ui/theme/theme.h"

#include <QHelpEvent>
#include <QLinearGradient>
#include <QPainter>
#include <QToolTip>

#include <algorithm>
#include <cmath>

namespace evical::ui {
namespace {

constexpr double kMapScale_px = 40.0, kBar_px = 10.0, kMapMargin_px = 4.0;

}  // namespace

ImageMapView::ImageMapView(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

void ImageMapView::setCells(ImageMapCells cells) {
  cells_ = std::move(cells);
  max_ = 0.0;
  for (const std::optional<double>& value : cells_.values)
    if (value && std::isfinite(*value)) max_ = std::max(max_, *value);
  if (!(max_ > 0.0)) max_ = 1.0;
  update();
}

QRectF ImageMapView::imageRect() const {
  const QRectF room = QRectF(rect()).adjusted(kMapMargin_px, kMapMargin_px, -kMapMargin_px, -kMapScale_px);
  const Resolution size = cells_.resolution_px;
  if (!size.known()) return room;
  const double scale = std::min(room.width() / size.width_px, room.height() / size.height_px);
  const QSizeF shown = scale * QSizeF(size.width_px, size.height_px);
  return {room.center().x() - 0.5 * shown.width(), room.top(), shown.width(), shown.height()};
}

// From the panel's colour to a clearly distinguishable one, also in lightness.
QColor ImageMapView::colourOf(double value) const {
  const QColor& end = cells_.more_is_better ? theme().accent : theme().warning;
  return mixed(theme().panel, end, 0.06 + 0.94 * std::clamp(value / max_, 0.0, 1.0));
}

QString ImageMapView::textOf(double value) const {
  return cells_.unit.isEmpty() ? QString::number(value, 'f', 0)
                               : QString::number(value, 'g', 2) + ' ' + cells_.unit;
}

void ImageMapView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setPen(theme().faint_text);
  if (cells_.values.empty()) {
    painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap, tr("No lens to compare with."));
    return;
  }
  const QRectF image = imageRect();
  const QSizeF cell(image.width() / cells_.columns, image.height() / cells_.rows);
  for (std::size_t k = 0; k < cells_.values.size(); ++k) {
    const auto columns = static_cast<std::size_t>(cells_.columns);
    const QPointF corner = image.topLeft() + QPointF(static_cast<double>(k % columns) * cell.width(),
                                                     static_cast<double>(k / columns) * cell.height());
    const QRectF place(corner, cell);
    const std::optional<double>& value = cells_.values[k];
    if (!value || !std::isfinite(*value)) {
      painter.fillRect(place, QBrush(theme().grid_line, Qt::BDiagPattern));
      continue;
    }
    painter.fillRect(place, colourOf(*value));
  }
  painter.setPen(theme().grid_line);
  painter.drawRect(image);
  paintScale(painter);
}

void ImageMapView::paintScale(QPainter& painter) const {
  const QRectF image = imageRect();
  const QRectF bar(image.left(), image.bottom() + 8.0, image.width(), kBar_px);
  QLinearGradient gradient(bar.topLeft(), bar.topRight());
  gradient.setColorAt(0.0, colourOf(0.0));
  gradient.setColorAt(1.0, colourOf(max_));
  painter.fillRect(bar, gradient);
  painter.drawRect(bar);
  painter.setPen(theme().faint_text);
  const QRectF text(bar.left(), bar.bottom() + 2.0, bar.width(), kMapScale_px - kBar_px - 10.0);
  painter.drawText(text, Qt::AlignLeft | Qt::AlignTop, "0");
  if (max_ >= 2.0 || !cells_.unit.isEmpty())
    painter.drawText(text, Qt::AlignHCenter | Qt::AlignTop, textOf(0.5 * max_));
  painter.drawText(text, Qt::AlignRight | Qt::AlignTop, textOf(max_));
}

QString ImageMapView::textAt(const QPoint& position) const {
  const QRectF image = imageRect();
  if (cells_.values.empty() || !image.contains(position)) return {};
  const QPointF part((position.x() - image.left()) / image.width(),
                     (position.y() - image.top()) / image.height());
  const int column = std::min(static_cast<int>(part.x() * cells_.columns), cells_.columns - 1);
  const int row = std::min(static_cast<int>(part.y() * cells_.rows), cells_.rows - 1);
  const std::optional<double>& value = cells_.values[static_cast<std::size_t>(row * cells_.columns + column)];
  const bool known = value && std::isfinite(*value);
  return tr("x %1 px, y %2 px: %3")
      .arg(part.x() * cells_.resolution_px.width_px, 0, 'f', 0)
      .arg(part.y() * cells_.resolution_px.height_px, 0, 'f', 0)
      .arg(known ? textOf(*value) : tr("outside the lens's field of view"));
}

bool ImageMapView::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto* const help = static_cast<QHelpEvent*>(event);
  QToolTip::showText(help->globalPos(), textAt(help->pos()), this);
  return true;
}

}  // namespace evical::ui
