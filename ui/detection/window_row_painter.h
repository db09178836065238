// SPDX-License-Identifier: GPL-3.0-or-later
// Paints a row of the list of windows: the picture, the state with its colour and shape of the timeline, and
// a short reason below it.
#pragma once

#include <QSize>
#include <QStyledItemDelegate>

namespace evical::ui {

inline constexpr QSize kPictureSize_px(64, 48);

class WindowRowPainter : public QStyledItemDelegate {
  Q_OBJECT

 public:
  using QStyledItemDelegate::QStyledItemDelegate;

  void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override;
  QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override;

 private:
  static void paintPicture(QPainter& painter, const QRect& cell, const QModelIndex& index);
  static void paintState(QPainter& painter, const QStyleOptionViewItem& option, const QModelIndex& index);
};

}  // namespace evical::ui
