// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/result/quantity_table.h"

#include "ui/theme/theme.h"

#include <QClipboard>
#include <QContextMenuEvent>
#include <QGuiApplication>
#include <QHeaderView>
#include <QKeyEvent>
#include <QMenu>

#include <algorithm>
#include <array>
#include <cmath>

namespace evical::ui {
namespace {

constexpr int kIndentation_px = 12;

QString unitAndDetail(const ParameterRow& row) {
  return row.detail.isEmpty() ? row.unit : QString(row.unit + " " + row.detail).trimmed();
}

QTreeWidgetItem* treeItem(const ParameterRow& row) {
  auto* const item = new QTreeWidgetItem({row.name, row.valueText(), row.sigmaText(), unitAndDetail(row),
                                          row.differenceText(), row.sigmasText()});
  using Table = QuantityTable;
  for (const int column : {Table::kValue, Table::kSigma, Table::kDifference, Table::kSigmas})
    item->setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
  constexpr double kFar = 3.0;
  if (row.difference && row.sigma > 0.0 && std::abs(*row.difference) > kFar * row.sigma)
    item->setForeground(Table::kSigmas, theme().warning);
  if (!row.remark.isEmpty()) {
    for (int column = 0; column < Table::kColumns; ++column) item->setToolTip(column, row.remark);
    item->setData(Table::kQuantity, Qt::AccessibleDescriptionRole, row.remark);
  }
  return item;
}

// "Camera left: lens (differences up to 1.3 sigmas)".
QString headingText(const ParameterGroup& group, bool compared) {
  if (!compared || !group.folded) return group.title;
  double largest = 0.0;
  for (const ParameterRow& row : group.rows)
    if (row.difference && row.sigma > 0.0) largest = std::max(largest, std::abs(*row.difference) / row.sigma);
  return QObject::tr("%1 (differences up to %2 %3)")
      .arg(group.title)
      .arg(largest, 0, 'f', 1)
      .arg(QChar(0x3c3));
}

}  // namespace

QuantityTable::QuantityTable(QWidget* parent) : QTreeWidget(parent) {
  setColumnCount(kColumns);
  setHeaderLabels({tr("Quantity"), tr("Value"), QString(QChar(0xb1)), tr("Unit"), tr("Difference"),
                   tr("in %1").arg(QChar(0x3c3))});
  setSelectionMode(QAbstractItemView::ExtendedSelection);
  setUniformRowHeights(true);
  setIndentation(kIndentation_px);
  header()->setSectionResizeMode(QHeaderView::Interactive);
  header()->setStretchLastSection(false);
  for (const int column : {kValue, kSigma, kDifference, kSigmas})
    headerItem()->setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
  headerItem()->setToolTip(kSigma, tr("Standard deviation"));
  headerItem()->setToolTip(kSigmas, tr("Difference in standard deviations"));
  setAccessibleName(tr("Calibrated quantities"));
  const auto remember = [this](QTreeWidgetItem* heading) {
    const int row = indexOfTopLevelItem(heading);
    if (row < 0) return;
    folded_[groups_[static_cast<std::size_t>(row)].title] = !heading->isExpanded();
    fitColumns();
  };
  connect(this, &QTreeWidget::itemExpanded, this, remember);
  connect(this, &QTreeWidget::itemCollapsed, this, remember);
}

// Filled in one step: a tree that grows item by item measures its columns each time.
void QuantityTable::setGroups(std::vector<ParameterGroup> groups, bool compared) {
  groups_ = std::move(groups);
  setColumnHidden(kDifference, !compared);
  setColumnHidden(kSigmas, !compared);
  // The comparison comes first, so that it is visible in a narrow table.
  header()->moveSection(header()->visualIndex(kDifference), compared ? kValue : kDifference);
  header()->moveSection(header()->visualIndex(kSigmas), compared ? kValue + 1 : kSigmas);
  QList<QTreeWidgetItem*> headings;
  for (const ParameterGroup& group : groups_) {
    auto* const heading = new QTreeWidgetItem({headingText(group, compared)});
    QFont bold = font();
    bold.setWeight(QFont::DemiBold);
    heading->setFont(kQuantity, bold);
    for (const ParameterRow& row : group.rows) heading->addChild(treeItem(row));
    headings << heading;
  }
  clear();
  addTopLevelItems(headings);
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    headings[static_cast<qsizetype>(i)]->setFirstColumnSpanned(true);
    const auto chosen = folded_.find(groups_[i].title);
    const bool folded = chosen == folded_.end() ? groups_[i].folded : chosen->second;
    headings[static_cast<qsizetype>(i)]->setExpanded(!folded);
  }
  fitColumns();
}

// Measures the visible texts: a header that resizes to contents asks the style for each item's size at every
// layout.
void QuantityTable::fitColumns() {
  const QFontMetrics metrics(font());
  const int margin_px = 2 * metrics.horizontalAdvance('0');
  std::array<int, kColumns> widths_px{};
  const auto widen = [&](int column, const QString& text) {
    int& width_px = widths_px[static_cast<std::size_t>(column)];
    width_px = std::max(width_px, metrics.horizontalAdvance(text) + margin_px);
  };
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    if (!topLevelItem(static_cast<int>(i))->isExpanded()) continue;
    for (const ParameterRow& row : groups_[i].rows) {
      widen(kQuantity, row.name);
      widen(kValue, row.valueText());
      widen(kSigma, row.sigmaText());
      widen(kUnit, unitAndDetail(row));
      widen(kDifference, row.differenceText());
      widen(kSigmas, row.sigmasText());
    }
  }
  names_px_ = widths_px[kQuantity] + 2 * kIndentation_px;
  for (int column = kValue; column < kColumns; ++column) {
    widen(column, headerItem()->text(column));
    setColumnWidth(column, widths_px[static_cast<std::size_t>(column)]);
  }
  widenNames();
}

// Remaining width, but at least that of the names.
void QuantityTable::widenNames() {
  int others_px = 0;
  for (int column = kValue; column < kColumns; ++column)
    if (!isColumnHidden(column)) others_px += columnWidth(column);
  setColumnWidth(kQuantity, std::max(names_px_, viewport()->width() - others_px));
}

void QuantityTable::addToContextMenu(QMenu* menu) {
  further_ = menu;
}

QString QuantityTable::selectedText() const {
  std::vector<ParameterGroup> selected;
  for (int i = 0; i < topLevelItemCount(); ++i) {
    const QTreeWidgetItem* const heading = topLevelItem(i);
    const ParameterGroup& group = groups_[static_cast<std::size_t>(i)];
    ParameterGroup chosen{group.title, {}};
    for (int k = 0; k < heading->childCount(); ++k)
      if (heading->isSelected() || heading->child(k)->isSelected())
        chosen.rows.push_back(group.rows[static_cast<std::size_t>(k)]);
    if (!chosen.rows.empty()) selected.push_back(std::move(chosen));
  }
  return selected.empty() ? QString() : tabbedText(selected);
}

QString QuantityTable::allText() const {
  return tabbedText(groups_);
}

void QuantityTable::copySelected() {
  if (const QString text = selectedText(); !text.isEmpty()) QGuiApplication::clipboard()->setText(text);
}

void QuantityTable::contextMenuEvent(QContextMenuEvent* event) {
  auto* const menu = new QMenu(this);
  menu->setAttribute(Qt::WA_DeleteOnClose);
  QAction* const copy = menu->addAction(icon("copy"), tr("&Copy"), this, &QuantityTable::copySelected);
  copy->setShortcut(QKeySequence::Copy);
  copy->setEnabled(!selectedItems().isEmpty());
  menu->addAction(tr("Copy &all"), this, [this] { QGuiApplication::clipboard()->setText(allText()); });
  if (further_ != nullptr) {
    menu->addSeparator();
    menu->addAction(further_->menuAction());
  }
  menu->popup(event->globalPos());
}

void QuantityTable::keyPressEvent(QKeyEvent* event) {
  if (event->matches(QKeySequence::Copy)) return copySelected();
  QTreeWidget::keyPressEvent(event);
}

void QuantityTable::resizeEvent(QResizeEvent* event) {
  QTreeWidget::resizeEvent(event);
  widenNames();
}

}  // namespace evical::ui
