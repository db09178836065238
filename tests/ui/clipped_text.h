// SPDX-License-Identifier: GPL-3.0-or-later
// Texts of a window that are clipped or painted over, found by comparing their sizes with the available
// space.
#pragma once

#include <QAbstractButton>
#include <QAbstractScrollArea>
#include <QComboBox>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QTableView>
#include <QToolButton>
#include <QTreeView>

namespace evical::ui::test {

constexpr int kTolerance_px = 1;  // sizes are rounded

// "ui::Form > QLabel 'Spacing' (60x17 of 74x17)".
inline QString placeOf(const QWidget& widget, const QString& text, QSize needed) {
  QString parents;
  for (const QWidget* parent = widget.parentWidget(); parent && !parent->isWindow();
       parent = parent->parentWidget())
    if (!QByteArray(parent->metaObject()->className()).startsWith('Q'))
      parents.prepend(QString::fromLatin1(parent->metaObject()->className()).section("::", -1) + " > ");
  return QString("%1%2 '%3' has %4x%5 of %6x%7 px")
      .arg(parents, widget.metaObject()->className(), text.left(60))
      .arg(widget.width())
      .arg(widget.height())
      .arg(needed.width())
      .arg(needed.height());
}

// The visible part of a widget before its parents clip it. A scroll area can show the rest, as far as it
// scrolls.
inline QSize roomOf(const QWidget& widget) {
  constexpr int kFar_px = 1 << 20;
  QRect room = widget.rect();
  for (const QWidget* at = &widget; at->parentWidget() && !at->isWindow(); at = at->parentWidget()) {
    const QWidget* const parent = at->parentWidget();
    QRect seen = parent->rect();
    const auto* const area = qobject_cast<const QAbstractScrollArea*>(parent->parentWidget());
    const bool scrolls = area && area->viewport() == parent;
    if (scrolls && area->horizontalScrollBarPolicy() != Qt::ScrollBarAlwaysOff) break;
    if (scrolls) seen.adjust(0, -kFar_px, 0, kFar_px);
    room = room.translated(at->pos()).intersected(seen);
    if (scrolls) break;
  }
  return room.size();
}

inline QSize neededBy(const QLabel& label) {
  if (!label.wordWrap()) return label.minimumSizeHint().expandedTo(label.sizeHint());
  return {label.minimumSizeHint().width(), label.heightForWidth(label.width())};
}

inline bool tooSmall(QSize room, QSize needed) {
  return room.width() + kTolerance_px < needed.width() || room.height() + kTolerance_px < needed.height();
}

inline bool showsText(const QAbstractButton& button) {
  if (button.text().isEmpty()) return false;
  const auto* const tool = qobject_cast<const QToolButton*>(&button);
  return tool == nullptr || tool->toolButtonStyle() != Qt::ToolButtonIconOnly || tool->icon().isNull();
}

// Columns whose header or a cell is clipped, without a tool tip with the full text.
inline void findCutCells(const QAbstractItemView& view, const QHeaderView& header, QStringList& found) {
  const QAbstractItemModel* const model = view.model();
  if (model == nullptr || header.isHidden()) return;
  for (int column = 0; column < model->columnCount(); ++column) {
    if (header.isSectionHidden(column)) continue;
    const QString title = model->headerData(column, Qt::Horizontal).toString();
    const int needed_px = header.fontMetrics().horizontalAdvance(title);
    if (!title.isEmpty() && needed_px > header.sectionSize(column))
      found << placeOf(header, title, {needed_px, header.height()});
    for (int row = 0; row < std::min(model->rowCount(), 50); ++row) {
      const QModelIndex index = model->index(row, column);
      const QString text = index.data().toString();
      const int text_px = view.fontMetrics().horizontalAdvance(text);
      const bool cut =
          text_px > header.sectionSize(column) && index.data(Qt::ToolTipRole).toString().isEmpty();
      if (cut && view.indexWidget(index) == nullptr) found << placeOf(view, text, {text_px, view.height()});
    }
  }
}

inline QStringList overlaidTexts(const QList<QWidget*>& with_text) {
  QStringList found;
  for (const QWidget* const one : with_text)
    for (const QWidget* const other : with_text) {
      if (one >= other || one->parentWidget() != other->parentWidget()) continue;
      const QRect common = one->geometry().intersected(other->geometry());
      if (common.width() > kTolerance_px && common.height() > kTolerance_px)
        found << QString("%1 overlaps another text").arg(placeOf(*one, one->objectName(), common.size()));
    }
  return found;
}

inline QStringList clippedTexts(const QWidget& root) {
  QStringList found;
  QList<QWidget*> with_text;
  for (QWidget* const widget : root.findChildren<QWidget*>()) {
    if (!widget->isVisible()) continue;
    if (const auto* const label = qobject_cast<QLabel*>(widget); label && !label->text().isEmpty()) {
      with_text << widget;
      if (tooSmall(roomOf(*label), neededBy(*label)))
        found << placeOf(*label, label->text(), neededBy(*label));
    }
    if (const auto* const button = qobject_cast<QAbstractButton*>(widget); button && showsText(*button)) {
      with_text << widget;
      if (tooSmall(roomOf(*button), button->minimumSizeHint()))
        found << placeOf(*button, button->text(), button->minimumSizeHint());
    }
    if (const auto* const box = qobject_cast<QComboBox*>(widget)) {
      const int needed_px = box->fontMetrics().horizontalAdvance(box->currentText());
      if (tooSmall(roomOf(*box), {needed_px, 0})) found << placeOf(*box, box->currentText(), {needed_px, 0});
    }
    if (const auto* const field = qobject_cast<QLineEdit*>(widget))
      if (tooSmall(roomOf(*field), field->size())) found << placeOf(*field, field->text(), field->size());
    if (const auto* const table = qobject_cast<QTableView*>(widget))
      findCutCells(*table, *table->horizontalHeader(), found);
    if (const auto* const tree = qobject_cast<QTreeView*>(widget))
      findCutCells(*tree, *tree->header(), found);
  }
  return found + overlaidTexts(with_text);
}

}  // namespace evical::ui::test
