// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/finding_table.h"

#include "core/report/assessment_report.h"
#include "core/report/html/html_text.h"
#include "ui/screens/format_number.h"
#include "ui/theme/theme.h"

#include <QClipboard>
#include <QContextMenuEvent>
#include <QEvent>
#include <QGuiApplication>
#include <QHeaderView>
#include <QKeyEvent>
#include <QMenu>
#include <QTreeWidgetItemIterator>

#include <algorithm>
#include <cmath>
#include <utility>

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

namespace evical::ui {
namespace {

QString sizeText(double value, const std::string& unit) {
  if (!std::isfinite(value)) return QChar(0x2013);
  return QString("%1 %2").arg(fromCore(html::significant(value, 2)), unitText(unit)).trimmed();
}

QString valueText(const ValueWithSigma& number) {
  return number.isKnown() ? withSigma(number.value, number.sigma) : QString();
}

QString titleOf(const Finding& finding) {
  const QString sensor =
      finding.against.empty()
          ? fromCore(finding.sensor)
          : QObject::tr("%1 against %2").arg(fromCore(finding.sensor), fromCore(finding.against));
  return QString("%1: %2").arg(sensor, fromCore(finding.title));
}

QIcon iconOf(const Finding& finding) {
  if (finding.changed) return icon("error", theme().bad);
  return finding.isConclusive() ? icon("done", theme().good) : icon("warning", theme().warning);
}

QString wordsOf(const Finding& finding) {
  if (finding.changed)
    return QObject::tr("Differs from the old value: its test value is %1, and chance explains at most %2")
        .arg(finding.sigmas, 0, 'f', 1)
        .arg(finding.limit_sigmas, 0, 'f', 1);
  if (finding.isConclusive()) return QObject::tr("No change; a relevant one would have been detected");
  return QObject::tr("No change detected, but these data are too weak to detect a relevant one");
}

QTreeWidgetItem* itemOf(const ComparedNumber& number) {
  const QString unit = unitText(number.unit), name = nameOfKey(number.name);
  auto* const item = new QTreeWidgetItem({unit.isEmpty() ? name : QString("%1 [%2]").arg(name, unit)});
  item->setText(FindingTable::kBefore, valueText(number.before));
  item->setText(FindingTable::kNow, valueText(number.now));
  if (number.joint.isKnown())
    item->setToolTip(FindingTable::kNow,
                     QObject::tr("With the old result as prior: %1").arg(valueText(number.joint)));
  return item;
}

QTreeWidgetItem* itemOf(const Finding& finding) {
  auto* const item = new QTreeWidgetItem({titleOf(finding)});
  item->setIcon(FindingTable::kVerdict, iconOf(finding));
  item->setText(FindingTable::kVerdict, verdictWords(finding.verdict()));
  item->setText(FindingTable::kSource, sourceWords(finding.source));
  item->setText(FindingTable::kChange, changeText(finding));
  item->setText(FindingTable::kTest,
                QObject::tr("%1 of %2").arg(finding.sigmas, 0, 'f', 1).arg(finding.limit_sigmas, 0, 'f', 1));
  if (finding.edge_px > 0.0) item->setText(FindingTable::kEdge, sizeText(finding.edge_px, "px"));
  item->setText(FindingTable::kDetectable, sizeText(finding.smallest_detectable_change, finding.unit));
  for (int column = 0; column < FindingTable::kColumns; ++column) item->setToolTip(column, wordsOf(finding));
  if (finding.required_detectability > 0.0)
    item->setToolTip(FindingTable::kDetectable,
                     QObject::tr("The verdict must rule out changes of %1")
                         .arg(sizeText(finding.required_detectability, finding.unit)));
  for (const ComparedNumber& number : finding.numbers) item->addChild(itemOf(number));
  return item;
}

}  // namespace

QString changeText(const Finding& finding) {
  if (!std::isfinite(finding.change_sigma)) return QChar(0x2013);
  return QString("%1 %2 %3")
      .arg(fromCore(html::significant(finding.change, 2)), QChar(0xb1),
           sizeText(finding.change_sigma, finding.unit));
}

FindingTable::FindingTable(QWidget* parent) : CopyTable(parent) {
  setObjectName("finding_table");
  setAccessibleName(tr("Change of each quantity"));
  setColumnCount(kColumns);
  setHeaderLabels({tr("Quantity"), tr("Verdict"), tr("From"), tr("Change"), tr("Before"), tr("Now"),
                   tr("Test"), tr("At the edge"), tr("Detectable")});
  headerItem()->setToolTip(kSource, tr("Source: stops, another IMU, or the trajectory"));
  headerItem()->setToolTip(kTest,
                           tr("Change of all numbers of the quantity relative to their covariance, and the\n"
                              "largest value that chance explains"));
  headerItem()->setToolTip(kEdge, tr("Shift of points at the image's edge, in pixels"));
  headerItem()->setToolTip(kDetectable, tr("Smallest change that these data show in 95 of 100 cases"));
  headerItem()->setToolTip(kNow, tr("Estimate from the new data alone"));
  alignNumbers(*headerItem(), kChange, kColumns);
  connect(this, &QTreeWidget::itemExpanded, this, &FindingTable::showNumberColumns);
  connect(this, &QTreeWidget::itemCollapsed, this, &FindingTable::showNumberColumns);
}

void FindingTable::setFindings(std::vector<Finding> findings) {
  findings_ = std::move(findings);
  fill();
}

void FindingTable::fill() {
  QList<QTreeWidgetItem*> items;
  for (const Finding& finding : findings_) {
    items << itemOf(finding);
    alignNumbers(*items.back(), kChange, kColumns);
  }
  const auto isOfRecording = [](const Finding& each) { return each.source == FindingSource::Recording; };
  const auto isAtEdge = [](const Finding& each) { return each.edge_px > 0.0; };
  setColumnHidden(kSource, std::all_of(findings_.begin(), findings_.end(), isOfRecording));
  setColumnHidden(kEdge, std::none_of(findings_.begin(), findings_.end(), isAtEdge));
  clear();
  addTopLevelItems(items);
  for (const int column : {kBefore, kNow}) setColumnHidden(column, false);
  expandAll();
  fitColumns();
  // Unchanged quantities are one line; changed ones show their numbers.
  collapseAll();
  for (int row = 0; row < items.size(); ++row)
    items[row]->setExpanded(findings_[static_cast<std::size_t>(row)].changed);
  showNumberColumns();
}

// Only rows below a quantity have numbers before and now.
void FindingTable::showNumberColumns() {
  bool any = false;
  for (int row = 0; row < topLevelItemCount(); ++row) any = any || topLevelItem(row)->isExpanded();
  for (const int column : {kBefore, kNow}) setColumnHidden(column, !any);
  widenFirst();
}

bool FindingTable::copies(int column) const {
  return column == kBefore || column == kNow || CopyTable::copies(column);
}

void FindingTable::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) fill();
  CopyTable::changeEvent(event);
}

StepTable::StepTable(QWidget* parent) : CopyTable(parent) {
  setObjectName("step_table");
  setAccessibleName(tr("Changes during the logs"));
  setRootIsDecorated(false);
  setIndentation(0);
  setColumnCount(kColumns);
  setHeaderLabels(
      {tr("Changed during the logs"), tr("At"), tr("Detected at"), tr("Change"), tr("Alternatives")});
  headerItem()->setToolTip(kAt, tr("Time of the change, in seconds since the logs' start"));
  headerItem()->setToolTip(kNoticed, tr("Time from which the logs show the change"));
  headerItem()->setToolTip(kAlternatives, tr("Other quantities that explain the data nearly as well"));
  alignNumbers(*headerItem(), kAt, kAlternatives);
}

void StepTable::setSteps(const std::vector<MaintenanceStep>& steps) {
  constexpr int kMax_rows = 4;
  clear();
  for (const MaintenanceStep& step : steps) {
    QStringList others, numbers;
    for (const std::string& other : step.alternatives) others << fromCore(other);
    for (const ComparedNumber& number : step.numbers)
      numbers << QString("%1: %2 %3")
                     .arg(nameOfKey(number.name), valueText(number.change), unitText(number.unit))
                     .trimmed();
    auto* const item = new QTreeWidgetItem({titleOf(step), QString("%1 s").arg(step.at_s, 0, 'f', 1),
                                            QString("%1 s").arg(step.noticed_s, 0, 'f', 1), changeText(step),
                                            others.join(", ")});
    alignNumbers(*item, kAt, kAlternatives);
    item->setToolTip(kBy, numbers.join('\n'));
    addTopLevelItem(item);
  }
  fitColumns();
  const int rows = std::min(static_cast<int>(steps.size()), kMax_rows);
  setFixedHeight(header()->sizeHint().height() + rows * std::max(sizeHintForRow(0), 1) + 2 * frameWidth() +
                 2);
  setVisible(!steps.empty());
}

}  // namespace evical::ui
