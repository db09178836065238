// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/window_row_painter.h"

#include "ui/detection/window_list_model.h"
#include "ui/theme/theme.h"

#include <QApplication>
#include <QPainter>
#include <QPixmap>

namespace evical::ui {
namespace {

constexpr int kMark_px = 8, kGap_px = 8;
constexpr double kFoundHeight = 0.7;  // relative to a missed one's mark, as on the timeline

}  // namespace

void WindowRowPainter::paint(QPainter* painter, const QStyleOptionViewItem& option,
                             const QModelIndex& index) const {
  if (index.column() != WindowListModel::Picture && index.column() != WindowListModel::State)
    return QStyledItemDelegate::paint(painter, option, index);
  QStyleOptionViewItem empty = option;
  initStyleOption(&empty, index);
  empty.text.clear();
  empty.icon = {};
  empty.features &= ~QStyleOptionViewItem::HasDecoration;
  const QStyle& style = option.widget != nullptr ? *option.widget->style() : *QApplication::style();
  style.drawControl(QStyle::CE_ItemViewItem, &empty, painter, option.widget);
  painter->save();
  if (index.column() == WindowListModel::Picture)
    paintPicture(*painter, option.rect, index);
  else
    paintState(*painter, empty, index);
  painter->restore();
}

QSize WindowRowPainter::sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const {
  const int two_lines = 2 * option.fontMetrics.height();
  return {QStyledItemDelegate::sizeHint(option, index).width(),
          std::max(kPictureSize_px.height(), two_lines) + 6};
}

void WindowRowPainter::paintPicture(QPainter& painter, const QRect& cell, const QModelIndex& index) {
  QRect place(QPoint(), kPictureSize_px);
  place.moveCenter(cell.center());
  const auto picture = index.data(Qt::DecorationRole).value<QPixmap>();
  if (!picture.isNull()) {
    place.setSize(picture.deviceIndependentSize().toSize());
    place.moveCenter(cell.center());
    painter.drawPixmap(place, picture);
  } else {
    painter.fillRect(place, theme().window);
  }
  painter.setPen(theme().grid_line);
  painter.setBrush(Qt::NoBrush);
  painter.drawRect(place);
}

void WindowRowPainter::paintState(QPainter& painter, const QStyleOptionViewItem& option,
                                  const QModelIndex& index) {
  const auto key = index.data(WindowListModel::kSortRole).toInt();
  const auto window_class = static_cast<WindowClass>(key / 100);
  const QRect cell = option.rect.adjusted(4, 6, -4, -6);
  const double height = cell.height() * (window_class == WindowClass::Missed ? 1.0 : kFoundHeight);
  const QRectF mark(cell.left(), cell.bottom() + 1 - height, kMark_px, height);
  const QColor background = option.state & QStyle::State_Selected ? option.palette.highlight().color()
                                                                  : option.palette.base().color();
  painter.fillRect(mark, background);
  painter.fillRect(mark, windowBrush(window_class));
  const QRect text = cell.adjusted(kMark_px + kGap_px, -4, 0, 4);
  const QString second = index.data(WindowListModel::kSecondLineRole).toString();
  const bool selected = option.state & QStyle::State_Selected;
  const QColor first_colour = option.palette.color(selected ? QPalette::HighlightedText : QPalette::Text);
  const QFontMetrics& metrics = option.fontMetrics;
  const auto line = [&](const QRect& at, const QColor& colour, const QString& words) {
    painter.setPen(colour);
    painter.drawText(at, Qt::AlignLeft | Qt::AlignVCenter,
                     metrics.elidedText(words, Qt::ElideRight, at.width()));
  };
  if (second.isEmpty()) return line(text, first_colour, index.data().toString());
  const int half = text.height() / 2;
  line(text.adjusted(0, 0, 0, -half), first_colour, index.data().toString());
  line(text.adjusted(0, half, 0, 0), selected ? first_colour : theme().faint_text, second);
}

}  // namespace evical::ui
