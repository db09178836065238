// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/result/runs_panel.h"

#include "ui/screens/verdict_labels.h"
#include "ui/theme/theme.h"

#include <QDateTime>
#include <QEvent>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QKeyEvent>
#include <QLabel>
#include <QLocale>
#include <QMessageBox>
#include <QPushButton>
#include <QSignalBlocker>
#include <QTreeWidget>
#include <QVBoxLayout>

#include <utility>

namespace evical::ui {
namespace {

enum RunColumn { kName, kMade, kVerdict, kRejected, kTook, kDiffers, kColumns };

QString pathText(const std::filesystem::path& path) {
  return QString::fromStdString(path.string());
}

QString dateText(const RunSummary& run) {
  return QLocale().toString(QDateTime::fromSecsSinceEpoch(run.made_s), QLocale::ShortFormat);
}

QString verdictText(CalibrationStatus status) {
  switch (status) {
    case CalibrationStatus::Ok:
      return QObject::tr("calibrated");
    case CalibrationStatus::Doubtful:
      return QObject::tr("doubtful");
    case CalibrationStatus::Failed:
      break;
  }
  return QObject::tr("failed");
}

QString differencesText(const RunSummary* before, const RunSummary& run) {
  if (before == nullptr) return QObject::tr("the first run");
  QStringList texts;
  for (const std::string& text : differingFrom(*before, run)) texts << QString::fromStdString(text);
  if (run.rejected_windows != before->rejected_windows) texts.prepend(QObject::tr("event windows rejected"));
  return texts.isEmpty() ? QObject::tr("none") : texts.join(", ");
}

}  // namespace

QString titleOf(const RunSummary& run) {
  return run.name.empty() ? QObject::tr("Run of %1").arg(dateText(run)) : QString::fromStdString(run.name);
}

RunsPanel::RunsPanel(QWidget* parent)
    : QWidget(parent),
      list_(new QTreeWidget(this)),
      open_(new QPushButton(icon("open"), tr("Open"), this)),
      compare_(new QPushButton(icon("compare"), tr("Compare"), this)),
      rename_(new QPushButton(tr("Rename"), this)),
      delete_(new QPushButton(icon("remove"), tr("Delete..."), this)),
      place_(new QLabel(this)) {
  list_->setColumnCount(kColumns);
  list_->setHeaderLabels({tr("Run"), tr("Date"), tr("Verdict"), tr("Rejected"), tr("Duration"),
                          tr("Changes to the previous run")});
  constexpr int kMinList_px = 48;  // its header and a run: the dock must not enlarge the window
  list_->setMinimumHeight(kMinList_px);
  list_->setRootIsDecorated(false);
  list_->setUniformRowHeights(true);
  list_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  list_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  list_->setAccessibleName(tr("Runs of this session"));
  list_->setToolTip(tr("Enter or a double click opens a run on all pages, F2 renames it, Delete deletes it"));
  open_->setToolTip(tr("Show this run on all pages; undo restores the previous one (Enter)"));
  compare_->setToolTip(
      tr("One run: compare the shown run with it. Two: show the first, compared with the second"));
  rename_->setToolTip(tr("Rename the run; named runs are kept longest (F2)"));
  delete_->setToolTip(tr("Delete the run's folder, after confirmation (Delete)"));
  place_->setProperty("role", "hint");
  place_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  place_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  connect(open_, &QPushButton::clicked, this, &RunsPanel::openChosen);
  connect(compare_, &QPushButton::clicked, this, &RunsPanel::compareChosen);
  connect(rename_, &QPushButton::clicked, this, &RunsPanel::renameChosen);
  connect(delete_, &QPushButton::clicked, this, &RunsPanel::deleteChosen);
  connect(list_, &QTreeWidget::itemSelectionChanged, this, &RunsPanel::offer);
  connect(list_, &QTreeWidget::itemActivated, this, &RunsPanel::openChosen);
  connect(list_, &QTreeWidget::itemChanged, this, [this](QTreeWidgetItem* item, int column) {
    if (column == kName) emit renameRequested(item->data(kName, Qt::UserRole).toString(), item->text(kName));
  });
  auto* const bar = new QHBoxLayout;
  for (QPushButton* const button : {open_, compare_, rename_, delete_}) {
    button->setAccessibleName(button->text().remove("..."));
    bar->addWidget(button);
  }
  bar->addWidget(place_, 1);
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(8, 4, 8, 8);
  layout->addWidget(list_, 1);
  layout->addLayout(bar);
  offer();
}

void RunsPanel::setRuns(std::vector<RunSummary> runs, const std::filesystem::path& shown) {
  runs_ = std::move(runs);
  shown_ = shown;
  fill();
}

void RunsPanel::setPlace(const QString& place) {
  place_->setText(place.isEmpty() ? QString() : tr("Stored in %1").arg(place));
  place_->setToolTip(place_->text());
}

void RunsPanel::setBusy(bool busy) {
  busy_ = busy;
  offer();
}

// Newest first.
void RunsPanel::fill() {
  const QSignalBlocker quiet(list_);
  const QStringList before = chosen();
  list_->clear();
  for (std::size_t i = runs_.size(); i-- > 0;) {
    const RunSummary& run = runs_[i];
    auto* const item = new QTreeWidgetItem(
        {titleOf(run), dateText(run), verdictText(run.status),
         run.rejected_windows > 0 ? QString::number(run.rejected_windows) : QString(),
         tr("%1 s").arg(run.took_s, 0, 'f', 1), differencesText(i > 0 ? &runs_[i - 1] : nullptr, run)});
    item->setData(kName, Qt::UserRole, pathText(run.folder));
    item->setFlags(item->flags() | Qt::ItemIsEditable);
    item->setIcon(kVerdict, verdictIcon(run.status));
    item->setToolTip(kVerdict, QString::fromStdString(run.reason));
    item->setToolTip(kDiffers, item->text(kDiffers));
    for (const int column : {kRejected, kTook})
      item->setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
    if (run.folder == shown_) {
      QFont bold = list_->font();
      bold.setBold(true);
      item->setFont(kName, bold);
      item->setToolTip(kName, tr("This run is shown on the pages"));
    }
    list_->addTopLevelItem(item);
    item->setSelected(before.contains(pathText(run.folder)));
  }
  for (int column = 0; column < kDiffers; ++column) list_->resizeColumnToContents(column);
  offer();
}

QStringList RunsPanel::chosen() const {
  QStringList folders;
  for (int row = 0; row < list_->topLevelItemCount(); ++row)
    if (const QTreeWidgetItem* const item = list_->topLevelItem(row); item->isSelected())
      folders << item->data(kName, Qt::UserRole).toString();
  return folders;
}

void RunsPanel::offer() {
  const QStringList folders = chosen();
  open_->setEnabled(folders.size() == 1 && !busy_);
  rename_->setEnabled(folders.size() == 1);
  delete_->setEnabled(!folders.isEmpty());
  const bool itself = folders.size() == 1 && folders.front() == pathText(shown_);
  compare_->setEnabled((folders.size() == 1 && !itself) || (folders.size() == 2 && !busy_));
}

void RunsPanel::openChosen() {
  if (open_->isEnabled()) emit openRequested(chosen().front());
}

void RunsPanel::compareChosen() {
  const QStringList folders = chosen();
  if (folders.size() == 1) return emit comparisonRequested({}, folders[0]);
  if (folders[1] == pathText(shown_)) return emit comparisonRequested({}, folders[0]);
  emit comparisonRequested(folders[0] == pathText(shown_) ? QString() : folders[0], folders[1]);
}

void RunsPanel::renameChosen() {
  const QList<QTreeWidgetItem*> items = list_->selectedItems();
  if (items.size() == 1) list_->editItem(items.front(), kName);
}

void RunsPanel::deleteChosen() {
  const QStringList folders = chosen();
  if (folders.isEmpty()) return;
  QMessageBox question(
      QMessageBox::Question, tr("Delete runs"),
      folders.size() == 1 ? tr("Delete this run?") : tr("Delete these %1 runs?").arg(folders.size()),
      QMessageBox::Yes | QMessageBox::Cancel, this);
  question.setInformativeText(tr("These folders are deleted permanently: %1").arg(folders.join(", ")));
  question.setDefaultButton(QMessageBox::Cancel);
  question.button(QMessageBox::Yes)->setText(tr("Delete"));
  if (question.exec() == QMessageBox::Yes) emit deletionRequested(folders);
}

// While a name is edited, the editor handles the keys.
void RunsPanel::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_F2) return renameChosen();
  if (event->key() == Qt::Key_Delete) return deleteChosen();
  QWidget::keyPressEvent(event);
}

void RunsPanel::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) fill();
  QWidget::changeEvent(event);
}

}  // namespace evical::ui
