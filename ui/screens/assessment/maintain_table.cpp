// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/maintain_table.h"

#include "core/report/html/html_text.h"
#include "ui/screens/number_words.h"
#include "ui/theme/theme.h"

#include <QEvent>
#include <QHeaderView>

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical::ui {
namespace {

QString unitSuffix(const std::string& unit) {
  return unit.empty() || unit == "1" ? QString() : " " + fromCore(unit);
}

QString maintainSize(double value, const std::string& unit) {
  if (!std::isfinite(value)) return QChar(0x2013);
  return fromCore(html::significant(value, 2)) + unitSuffix(unit);
}

QString sizeWithSigma(double value, double sigma, const std::string& unit) {
  if (!std::isfinite(sigma)) return QChar(0x2013);
  return QString("%1 %2 %3")
      .arg(fromCore(html::significant(value, 2)), QChar(0xb1), maintainSize(sigma, unit));
}

QString sensorText(const std::string& sensor, const std::string& against) {
  return against.empty() ? fromCore(sensor)
                         : QObject::tr("%1 against %2").arg(fromCore(sensor), fromCore(against));
}

QString maintainVerdictOf(const MaintainedQuantity& quantity) {
  if (quantity.changed) return QObject::tr("changed");
  return quantity.told() ? QObject::tr("unchanged") : QObject::tr("undecided");
}

QIcon maintainIconOf(const MaintainedQuantity& quantity) {
  if (quantity.changed) return icon("error", theme().bad);
  return quantity.told() ? icon("done", theme().good) : icon("warning", theme().warning);
}

QString sourceOf(MaintenanceSource source) {
  switch (source) {
    case MaintenanceSource::Stops:
      return QObject::tr("stops");
    case MaintenanceSource::Trajectory:
      return QObject::tr("trajectory");
    case MaintenanceSource::OtherImu:
      break;
  }
  return QObject::tr("pair");
}

QString maintainWordsOf(const MaintainedQuantity& quantity) {
  if (quantity.changed)
    return QObject::tr(
               "It is further from the old value than chance explains (chi squared %1; %2 is allowed)")
        .arg(quantity.chi_square, 0, 'f', 1)
        .arg(quantity.limit, 0, 'f', 1);
  if (quantity.told()) return QObject::tr("No change is seen, and one that matters would have been");
  return QObject::tr("No change is seen, but this log would not have shown one that matters");
}

QTreeWidgetItem* maintainItemOf(const MaintainedNumber& number) {
  const QString unit = unitSuffix(number.unit).trimmed();
  auto* const item = new QTreeWidgetItem(
      {unit.isEmpty() ? fromCore(number.name) : QString("%1 [%2]").arg(fromCore(number.name), unit)});
  item->setText(MaintainTable::kBefore, withSigma(number.before, number.before_sigma));
  item->setText(MaintainTable::kNow, withSigma(number.now, number.now_sigma));
  return item;
}

QString noticeText(const MaintainedQuantity& quantity) {
  if (!std::isfinite(quantity.would_notice)) return QChar(0x2013);
  return QString("%1 (%2)%3")
      .arg(fromCore(html::significant(quantity.would_notice, 2)),
           fromCore(html::significant(quantity.matters, 2)), unitSuffix(quantity.unit));
}

QTreeWidgetItem* maintainItemOf(const MaintainedQuantity& quantity) {
  auto* const item = new QTreeWidgetItem(
      {QString("%1: %2").arg(sensorText(quantity.sensor, quantity.against), fromCore(quantity.title))});
  item->setIcon(MaintainTable::kVerdict, maintainIconOf(quantity));
  item->setText(MaintainTable::kVerdict, maintainVerdictOf(quantity));
  item->setText(MaintainTable::kSource, sourceOf(quantity.source));
  item->setText(MaintainTable::kChange, sizeWithSigma(quantity.change, quantity.change_sigma, quantity.unit));
  item->setText(MaintainTable::kNotice, noticeText(quantity));
  for (int column = 0; column < MaintainTable::kColumns; ++column)
    item->setToolTip(column, maintainWordsOf(quantity));
  for (const MaintainedNumber& number : quantity.numbers) item->addChild(maintainItemOf(number));
  return item;
}

}  // namespace

MaintainTable::MaintainTable(QWidget* parent) : CopyTable(parent) {
  setObjectName("maintain_table");
  setAccessibleName(tr("What has changed since the calibration, quantity by quantity"));
  setColumnCount(kColumns);
  setHeaderLabels(
      {tr("Quantity"), tr("Verdict"), tr("From"), tr("Change"), tr("Would notice"), tr("Before"), tr("Now")});
  headerItem()->setToolTip(kSource, tr("What tells: stops, the pair of IMUs, or the trajectory"));
  headerItem()->setToolTip(kNotice,
                           tr("The smallest change that these logs show in 95 of 100 cases; in brackets the\n"
                              "smallest that the verdict asks about"));
  headerItem()->setToolTip(kNow, tr("What the logs say by themselves"));
  alignNumbers(*headerItem(), kChange, kColumns);
}

void MaintainTable::setQuantities(std::vector<MaintainedQuantity> quantities) {
  quantities_ = std::move(quantities);
  fill();
}

void MaintainTable::fill() {
  QList<QTreeWidgetItem*> items;
  for (const MaintainedQuantity& quantity : quantities_) {
    items << maintainItemOf(quantity);
    alignNumbers(*items.back(), kChange, kColumns);
  }
  clear();
  addTopLevelItems(items);
  expandAll();
  fitColumns();
  // What is in order is a line; what has changed shows its numbers.
  collapseAll();
  for (int row = 0; row < items.size(); ++row)
    items[row]->setExpanded(quantities_[static_cast<std::size_t>(row)].changed);
}

void MaintainTable::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) fill();
  CopyTable::changeEvent(event);
}

StepTable::StepTable(QWidget* parent) : CopyTable(parent) {
  setObjectName("step_table");
  setAccessibleName(tr("What changed on the way"));
  setRootIsDecorated(false);
  setIndentation(0);
  setColumnCount(kColumns);
  setHeaderLabels({tr("Changed on the way"), tr("At"), tr("Noticed at"), tr("By"), tr("Or else")});
  headerItem()->setToolTip(kAt, tr("Seconds since the logs' start"));
  headerItem()->setToolTip(kNoticed, tr("From when on the logs tell it"));
  headerItem()->setToolTip(kOrElse, tr("Quantities that explain it nearly as well"));
  alignNumbers(*headerItem(), kAt, kOrElse);
}

void StepTable::setSteps(const std::vector<MaintenanceStep>& steps) {
  constexpr int kMost_rows = 4;
  clear();
  for (const MaintenanceStep& step : steps) {
    QStringList others;
    for (const std::string& other : step.or_else) others << fromCore(other);
    auto* const item = new QTreeWidgetItem(
        {QString("%1: %2").arg(sensorText(step.sensor, step.against), fromCore(step.title)),
         QString("%1 s").arg(step.at_s, 0, 'f', 1), QString("%1 s").arg(step.noticed_s, 0, 'f', 1),
         sizeWithSigma(step.size, step.size_sigma, step.unit), others.join(", ")});
    alignNumbers(*item, kAt, kOrElse);
    for (const MaintainedNumber& number : step.numbers)
      item->setToolTip(kBy, QString("%1\n%2: %3")
                                .arg(item->toolTip(kBy), fromCore(number.name),
                                     withSigma(number.now, number.now_sigma) + unitSuffix(number.unit))
                                .trimmed());
    addTopLevelItem(item);
  }
  fitColumns();
  const int rows = std::min(static_cast<int>(steps.size()), kMost_rows);
  setFixedHeight(header()->sizeHint().height() + rows * std::max(sizeHintForRow(0), 1) + 2 * frameWidth() +
                 2);
  setVisible(!steps.empty());
}

}  // namespace evical::ui
