// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/copy_table.h"

#include "ui/theme/theme.h"

#include <QClipboard>
#include <QContextMenuEvent>
#include <QGuiApplication>
#include <QHeaderView>
#include <QKeyEvent>
#include <QMenu>
#include <QTreeWidgetItemIterator>

#include <algorithm>

namespace evical::ui {

CopyTable::CopyTable(QWidget* parent) : QTreeWidget(parent) {
  constexpr int kIndentation_px = 10;
  setSelectionMode(QAbstractItemView::ExtendedSelection);
  setUniformRowHeights(true);
  setIndentation(kIndentation_px);
  header()->setStretchLastSection(false);
}

void CopyTable::fitColumns() {
  for (int column = 0; column < columnCount(); ++column)
    if (!isColumnHidden(column)) resizeColumnToContents(column);
  first_px_ = columnWidth(0);
  widenFirst();
}

void CopyTable::alignNumbers(QTreeWidgetItem& item, int first, int end) {
  for (int column = first; column < end; ++column)
    item.setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
  for (int row = 0; row < item.childCount(); ++row) alignNumbers(*item.child(row), first, end);
}

void CopyTable::widenFirst() {
  int others_px = 0;
  for (int column = 1; column < columnCount(); ++column)
    if (!isColumnHidden(column)) others_px += columnWidth(column);
  if (first_px_ > 0) setColumnWidth(0, std::max(first_px_, viewport()->width() - others_px));
}

void CopyTable::resizeEvent(QResizeEvent* event) {
  QTreeWidget::resizeEvent(event);
  widenFirst();
}

QString CopyTable::rowsText(bool only_selected) const {
  const auto line = [this](const QTreeWidgetItem& item, const QString& group) {
    QStringList cells;
    for (int column = 0; column < columnCount(); ++column)
      if (copies(column)) cells << item.text(column);
    if (!group.isEmpty()) cells.front().prepend(group + ": ");
    return cells.join('\t');
  };
  QStringList lines;
  for (QTreeWidgetItemIterator it(const_cast<CopyTable*>(this)); *it; ++it) {
    const QTreeWidgetItem& item = **it;
    const bool chosen = item.isSelected() || (item.parent() && item.parent()->isSelected());
    if (only_selected && !chosen) continue;
    lines << line(item, item.parent() ? item.parent()->text(0) : QString());
  }
  if (lines.isEmpty()) return {};
  return line(*headerItem(), {}) + '\n' + lines.join('\n') + '\n';
}

QString CopyTable::selectedText() const {
  return rowsText(true);
}

QString CopyTable::allText() const {
  return rowsText(false);
}

void CopyTable::copySelected() {
  if (const QString chosen = selectedText(); !chosen.isEmpty()) QGuiApplication::clipboard()->setText(chosen);
}

void CopyTable::contextMenuEvent(QContextMenuEvent* event) {
  auto* const menu = new QMenu(this);
  menu->setAttribute(Qt::WA_DeleteOnClose);
  QAction* const copy = menu->addAction(icon("copy"), tr("&Copy"), this, &CopyTable::copySelected);
  copy->setShortcut(QKeySequence::Copy);
  copy->setEnabled(!selectedItems().isEmpty());
  menu->addAction(tr("Copy &all"), this, [this] { QGuiApplication::clipboard()->setText(allText()); });
  menu->popup(event->globalPos());
}

void CopyTable::keyPressEvent(QKeyEvent* event) {
  if (event->matches(QKeySequence::Copy)) return copySelected();
  QTreeWidget::keyPressEvent(event);
}

}  // namespace evical::ui
