// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/repeat_table.h"

#include "core/report/assessment_report.h"
#include "core/report/html/html_text.h"
#include "ui/screens/assessment/finding_table.h"
#include "ui/screens/format_number.h"
#include "ui/theme/theme.h"

#include <QEvent>

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical::ui {
namespace {

constexpr double kFar_sigmas = 3.0;

QString shownNumber(const std::optional<ValueWithSigma>& number) {
  return number ? withSigma(number->value, number->sigma) : QString(QChar(0x2013));
}

QIcon repeatIconOf(const RepeatedRecording& recording) {
  if (recording.outcome == RepeatOutcome::Failed) return icon("error", theme().bad);
  if (recording.outcome == RepeatOutcome::DoesNotFit) return icon("warning", theme().warning);
  return icon("done", theme().good);
}

QString repeatWordsOf(const RepeatedRecording& recording) {
  QStringList parts;
  for (const Finding& finding : recording.findings)
    parts << QObject::tr("%1 of %2 differs by %3")
                 .arg(fromCore(finding.title), fromCore(finding.sensor), changeText(finding));
  if (!recording.reason.empty()) parts << fromCore(recording.reason);
  return parts.isEmpty() ? QObject::tr("agrees with the others") : parts.join("; ");
}

}  // namespace

RepeatTable::RepeatTable(QWidget* parent) : CopyTable(parent) {
  setObjectName("repeat_table");
  setAccessibleName(tr("Each number over the recordings"));
  setColumnCount(kColumns);
  setHeaderLabels({tr("Number"),
                   tr("Mean"),
                   tr("Std"),
                   tr("Mean %1").arg(QChar(0x3c3)),
                   tr("Ratio"),
                   tr("Together"),
                   {},
                   {},
                   tr("Difference"),
                   tr("in %1").arg(QChar(0x3c3))});
  headerItem()->setToolTip(kDeviation, tr("Standard deviation over the recordings"));
  headerItem()->setToolTip(kMeanSigma, tr("Standard deviation that the recordings' sigmas predict"));
  headerItem()->setToolTip(
      kRatio, tr("Observed over predicted standard deviation: near 1 if the sigmas are realistic"));
  headerItem()->setToolTip(kTogether, tr("Joint solution of all recordings that fit"));
  headerItem()->setToolTip(kSigmas, tr("Difference in units of its standard deviation"));
  alignNumbers(*headerItem(), kMean, kColumns);
  comparePair({});
}

void RepeatTable::setRepeat(const Repeatability& repeat) {
  repeat_ = repeat;
  pair_.reset();
  fill();
}

void RepeatTable::comparePair(const std::optional<Pair>& pair) {
  pair_ = pair;
  headerItem()->setText(kFirst, pair ? pair->first_name : QString());
  headerItem()->setText(kSecond, pair ? pair->second_name : QString());
  fill();
}

void RepeatTable::fillPair(const RepeatedNumber& number, QTreeWidgetItem& item) const {
  item.setText(kFirst, shownNumber(numberOf(number, pair_->first)));
  item.setText(kSecond, shownNumber(numberOf(number, pair_->second)));
  const auto difference = differenceOf(repeat_, number, pair_->first, pair_->second);
  item.setText(kDifference, shownNumber(difference));
  if (!difference || difference->sigma <= 0.0) return;
  const double sigmas = difference->value / difference->sigma;
  item.setText(kSigmas, QString::number(sigmas, 'f', 1));
  if (std::abs(sigmas) > kFar_sigmas) item.setForeground(kSigmas, theme().warning);
}

QTreeWidgetItem* RepeatTable::itemOf(const RepeatedNumber& number) const {
  const QString unit = unitText(number.unit), name = nameOfKey(number.name);
  auto* const item = new QTreeWidgetItem({unit.isEmpty() ? name : QString("%1 [%2]").arg(name, unit)});
  // Number of decimals according to the spread.
  const double spread = number.deviation > 0.0 ? number.deviation : number.mean_sigma;
  item->setText(kMean, QString::number(number.mean, 'f', decimalsFor(spread)));
  if (number.count > 1) {
    item->setText(kDeviation, fromCore(html::significant(number.deviation, 2)));
    item->setText(kRatio, QString::number(number.ratio(), 'f', 2));
  }
  item->setText(kMeanSigma, fromCore(html::significant(number.mean_sigma, 2)));
  item->setText(kTogether, shownNumber(numberOf(number, kAllTogether)));
  if (pair_) fillPair(number, *item);
  alignNumbers(*item, kMean, kColumns);
  return item;
}

void RepeatTable::fill() {
  QList<QTreeWidgetItem*> headings;
  for (const RepeatedQuantity& quantity : repeat_.quantities) {
    const QString own = quantity.common ? QString() : tr(" (separate for each recording)");
    auto* const heading = new QTreeWidgetItem(
        {QString("%1: %2%3").arg(fromCore(quantity.sensor), fromCore(quantity.title), own)});
    QFont bold = font();
    bold.setWeight(QFont::DemiBold);
    heading->setFont(kNumber, bold);
    for (const RepeatedNumber& number : quantity.numbers) heading->addChild(itemOf(number));
    headings << heading;
  }
  clear();
  addTopLevelItems(headings);
  for (const int column : {kFirst, kSecond, kDifference, kSigmas}) setColumnHidden(column, !pair_);
  expandAll();
  fitColumns();
  for (QTreeWidgetItem* const heading : headings) heading->setFirstColumnSpanned(true);
}

void RepeatTable::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) fill();
  CopyTable::changeEvent(event);
}

RepeatedList::RepeatedList(QWidget* parent) : CopyTable(parent) {
  setObjectName("repeated_list");
  setAccessibleName(tr("Fit of each recording"));
  setRootIsDecorated(false);
  setIndentation(0);
  setColumnCount(kColumns);
  setHeaderLabels({tr("Recording"), tr("Verdict"), tr("Distance"), tr("Reason"), tr("File")});
  headerItem()->setToolTip(
      kDistance, tr("Distance from all others that fit (chi squared), and the largest that chance explains"));
  alignNumbers(*headerItem(), kDistance, kDistance + 1);
}

void RepeatedList::setRecordings(std::vector<RepeatedRecording> recordings) {
  recordings_ = std::move(recordings);
  fill();
}

std::optional<std::size_t> RepeatedList::chosen() const {
  const QList<QTreeWidgetItem*> items = selectedItems();
  if (items.size() != 1) return std::nullopt;
  return static_cast<std::size_t>(indexOfTopLevelItem(items.front()));
}

void RepeatedList::fill() {
  constexpr int kMax_px = 420;
  QList<QTreeWidgetItem*> items;
  for (const RepeatedRecording& recording : recordings_) {
    const QString distance =
        recording.freedom > 0
            ? tr("%1 of %2").arg(recording.chi_square, 0, 'f', 1).arg(recording.limit, 0, 'f', 1)
            : QString();
    auto* const item = new QTreeWidgetItem({fromCore(recording.name), outcomeWords(recording.outcome),
                                            distance, repeatWordsOf(recording), fromCore(recording.file)});
    item->setIcon(kOutcome, repeatIconOf(recording));
    alignNumbers(*item, kDistance, kDistance + 1);
    for (const int column : {kName, kWhat, kFile}) item->setToolTip(column, item->text(column));
    items << item;
  }
  clear();
  addTopLevelItems(items);
  fitColumns();
  setColumnWidth(kWhat, std::min(columnWidth(kWhat), kMax_px));
}

void RepeatedList::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) fill();
  CopyTable::changeEvent(event);
}

}  // namespace evical::ui
