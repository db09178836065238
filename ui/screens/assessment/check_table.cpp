// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/check_table.h"

#include "core/report/html/html_text.h"
#include "ui/screens/number_words.h"
#include "ui/theme/theme.h"

#include <QEvent>

#include <utility>

namespace evical::ui {
namespace {

QString size(double value, const std::string& unit) {
  return QString("%1 %2").arg(fromCore(html::significant(value, 2)), fromCore(unit)).trimmed();
}

QString verdictOf(const CheckedQuantity& quantity) {
  if (quantity.changed) return QObject::tr("changed");
  return quantity.toldEnough() ? QObject::tr("unchanged") : QObject::tr("undecided");
}

QIcon iconOf(const CheckedQuantity& quantity) {
  if (quantity.changed) return icon("error", theme().bad);
  return quantity.toldEnough() ? icon("done", theme().good) : icon("warning", theme().warning);
}

QString wordsOf(const CheckedQuantity& quantity) {
  if (quantity.changed)
    return QObject::tr("It is further from the old value than chance explains (%1 sigmas; %2 are allowed)")
        .arg(quantity.sigmas, 0, 'f', 1)
        .arg(quantity.limit_sigmas, 0, 'f', 1);
  if (quantity.toldEnough()) return QObject::tr("No change is seen, and one that matters would have been");
  return QObject::tr("No change is seen, but this recording would not have shown one that matters");
}

QTreeWidgetItem* itemOf(const CheckedNumber& number) {
  auto* const item = new QTreeWidgetItem({fromCore(number.name)});
  const QString unit = number.unit.empty() ? QString() : " " + fromCore(number.unit);
  item->setText(CheckTable::kBefore, withSigma(number.before, number.before_sigma) + unit);
  item->setText(CheckTable::kNow, withSigma(number.now, number.now_sigma) + unit);
  item->setToolTip(CheckTable::kNow, QObject::tr("With the old result as prior: %1%2")
                                         .arg(withSigma(number.together, number.together_sigma), unit));
  return item;
}

QTreeWidgetItem* itemOf(const CheckedQuantity& quantity) {
  auto* const item =
      new QTreeWidgetItem({QString("%1: %2").arg(fromCore(quantity.sensor), fromCore(quantity.title))});
  item->setIcon(CheckTable::kVerdict, iconOf(quantity));
  item->setText(CheckTable::kVerdict, verdictOf(quantity));
  item->setText(CheckTable::kChange, QString("%1 %2 %3")
                                         .arg(fromCore(html::significant(quantity.change, 2)), QChar(0xb1),
                                              size(quantity.change_sigma, quantity.unit)));
  item->setText(CheckTable::kSigmas, QString::number(quantity.sigmas, 'f', 1));
  if (quantity.edge_px > 0.0) item->setText(CheckTable::kEdge, size(quantity.edge_px, "px"));
  item->setText(CheckTable::kNotice, size(quantity.would_notice, quantity.unit));
  if (quantity.matters > 0.0) item->setText(CheckTable::kMatters, size(quantity.matters, quantity.unit));
  for (int column = 0; column < CheckTable::kColumns; ++column) item->setToolTip(column, wordsOf(quantity));
  for (const CheckedNumber& number : quantity.numbers) item->addChild(itemOf(number));
  return item;
}

}  // namespace

CheckTable::CheckTable(QWidget* parent) : CopyTable(parent) {
  setObjectName("check_table");
  setAccessibleName(tr("What has changed, quantity by quantity"));
  setColumnCount(kColumns);
  setHeaderLabels({tr("Quantity"), tr("Verdict"), tr("Change"), QString(QChar(0x3c3)), tr("At the edge"),
                   tr("Would notice"), tr("Matters"), tr("Before"), tr("Now, alone")});
  headerItem()->setToolTip(kSigmas, tr("The change in standard deviations"));
  headerItem()->setToolTip(kEdge, tr("By how many pixels it moves points at the image's edge"));
  headerItem()->setToolTip(kNotice, tr("The smallest change that this recording shows in 95 of 100 cases"));
  headerItem()->setToolTip(kMatters, tr("The smallest change that the verdict asks about"));
  headerItem()->setToolTip(kNow, tr("What the new recording says by itself"));
  alignNumbers(*headerItem(), kChange, kColumns);
}

void CheckTable::setQuantities(std::vector<CheckedQuantity> quantities) {
  quantities_ = std::move(quantities);
  fill();
}

void CheckTable::fill() {
  QList<QTreeWidgetItem*> items;
  for (const CheckedQuantity& quantity : quantities_) items << itemOf(quantity);
  for (QTreeWidgetItem* const item : items) alignNumbers(*item, kChange, kColumns);
  clear();
  addTopLevelItems(items);
  expandAll();
  fitColumns();
  // What is in order is a line; what has changed shows its numbers.
  collapseAll();
  for (int row = 0; row < items.size(); ++row)
    items[row]->setExpanded(quantities_[static_cast<std::size_t>(row)].changed);
}

void CheckTable::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) fill();
  CopyTable::changeEvent(event);
}

}  // namespace evical::ui
