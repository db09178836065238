// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/board/sheet_preview.h"

#include "ui/theme/theme.h"

#include <QPainter>

#include <algorithm>
#include <utility>

namespace evical::ui {
namespace {

void paintBox(QPainter& painter, const SheetBox& box) {
  painter.fillRect(QRectF(box.x_mm, box.y_mm, box.width_mm, box.height_mm),
                   box.bright ? Qt::white : Qt::black);
}

}  // namespace

void paintSheet(QPainter& painter, const BoardSheet& sheet) {
  painter.fillRect(QRectF(0.0, 0.0, sheet.width_mm, sheet.height_mm), Qt::white);
  for (const SheetBox& box : sheet.boxes) paintBox(painter, box);
  painter.setPen(Qt::NoPen);
  painter.setBrush(sheet.bright_circles ? Qt::white : Qt::black);
  for (const Eigen::Vector2d& centre_mm : sheet.centres_mm)
    painter.drawEllipse(QPointF(centre_mm.x(), centre_mm.y()), sheet.radius_mm, sheet.radius_mm);
  paintBox(painter, sheet.ruler);
  // Fonts have integer pixel sizes, so a large font is scaled down.
  constexpr int kLetter_px = 100;
  QFont font("Helvetica");
  font.setPixelSize(kLetter_px);
  painter.save();
  painter.translate(sheet.caption_x_mm, sheet.caption_y_mm);
  painter.scale(sheet.text_size_mm / kLetter_px, sheet.text_size_mm / kLetter_px);
  painter.setFont(font);
  painter.setPen(Qt::black);
  painter.drawText(QPointF(0.0, 0.0), QString::fromStdString(sheet.caption));
  painter.restore();
}

SheetPreview::SheetPreview(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setAccessibleName(tr("Preview of the sheet"));
}

void SheetPreview::setSheet(std::optional<BoardSheet> sheet) {
  sheet_ = std::move(sheet);
  setToolTip(sheet_ ? tr("Sheet of %1 mm x %2 mm, as printed")
                          .arg(sheet_->width_mm, 0, 'f', 0)
                          .arg(sheet_->height_mm, 0, 'f', 0)
                    : tr("No preview: the board cannot be printed"));
  setAccessibleDescription(sheet_ ? QString::fromStdString(sheet_->caption) : toolTip());
  update();
}

void SheetPreview::paintEvent(QPaintEvent*) {
  if (!sheet_) return;
  constexpr double kMargin_px = 10.0;
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const double px_per_mm = std::min((width() - 2.0 * kMargin_px) / sheet_->width_mm,
                                    (height() - 2.0 * kMargin_px) / sheet_->height_mm);
  painter.translate(0.5 * (width() - px_per_mm * sheet_->width_mm),
                    0.5 * (height() - px_per_mm * sheet_->height_mm));
  painter.scale(px_per_mm, px_per_mm);
  paintSheet(painter, *sheet_);
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(theme().grid_line, 1.0 / px_per_mm));
  painter.drawRect(QRectF(0.0, 0.0, sheet_->width_mm, sheet_->height_mm));
}

}  // namespace evical::ui
