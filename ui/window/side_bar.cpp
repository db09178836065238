// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/side_bar.h"

#include "core/report/result_yaml.h"
#include "ui/screens/verdict_labels.h"
#include "ui/theme/theme.h"

#include <QEvent>
#include <QListWidget>
#include <QSettings>
#include <QVBoxLayout>

#include <algorithm>

namespace evical::ui {
namespace {

constexpr int kSideBar_px = 236, kIcon_px = 20, kPage_px = 31, kHeading_px = 30, kReason_px = 22;
constexpr int kMinPages_px = 190, kMinSteps_px = 70;
constexpr int kPageRole = Qt::UserRole;  // headings have none
const char* const kFoldedKey = "window/more_folded";

// The list has the height of its pages, and scrolls in a window that is lower.
class PageList final : public QListWidget {
 public:
  using QListWidget::QListWidget;
  QSize sizeHint() const override { return {QListWidget::sizeHint().width(), maximumHeight()}; }
  QSize minimumSizeHint() const override { return {0, kMinPages_px}; }
};

}  // namespace

SideBar::SideBar(const std::vector<PageEntry>& pages, QWidget* below, QWidget* parent)
    : QFrame(parent), pages_(pages), list_(new PageList(this)) {
  setObjectName("sidebar");
  setFixedWidth(kSideBar_px);
  list_->setObjectName("navigation");
  list_->setAccessibleName(tr("Screens"));
  list_->setIconSize(QSize(kIcon_px, kIcon_px));
  list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  list_->setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
  list_->setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Maximum);
  below->setMinimumHeight(kMinSteps_px);
  addPages();
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  layout->addWidget(list_);
  layout->addWidget(below, 1);
  layout->addStretch();
  foldMore(QSettings().value(kFoldedKey, true).toBool());
  connect(list_, &QListWidget::currentItemChanged, this, [this](const QListWidgetItem* item) {
    if (item && item->data(kPageRole).isValid()) emit pageChosen(item->data(kPageRole).toInt());
  });
  connect(list_, &QListWidget::itemClicked, this, [this](const QListWidgetItem* item) {
    if (item->data(kPageRole).isValid()) emit pageClicked();
  });
  const auto toggle = [this](const QListWidgetItem* item) {
    if (item != more_) return;
    foldMore(!folded_);
    QSettings().setValue(kFoldedKey, folded_);
  };
  connect(list_, &QListWidget::itemPressed, this, toggle);
  connect(list_, &QListWidget::itemActivated, this, toggle);
}

void SideBar::addPages() {
  for (std::size_t i = 0; i < pages_.size(); ++i) {
    const bool first = i == 0 || pages_[i].group != pages_[i - 1].group;
    if (first && pages_[i].group == PageGroup::ThisRecording) {
      addHeading(tr("This recording"));
      reason_ = addHeading({});
    }
    if (first && pages_[i].group == PageGroup::More) more_ = addHeading(tr("More"));
    addPage(i);
  }
  reason_->setSizeHint(QSize(0, kReason_px));
  QFont font = list_->font();
  font.setPointSizeF(0.9 * font.pointSizeF());
  font.setBold(false);
  reason_->setFont(font);
  more_->setFlags(Qt::ItemIsEnabled);
  colourHeadings();
  more_->setToolTip(tr("Pages for several recordings and for results of earlier days"));
}

void SideBar::addPage(std::size_t page) {
  auto* const item = new QListWidgetItem(icon(pages_[page].icon_name), pages_[page].title, list_);
  item->setData(kPageRole, static_cast<int>(page));
  item->setSizeHint(QSize(0, kPage_px));
  items_.push_back(item);
}

QListWidgetItem* SideBar::addHeading(const QString& text) {
  auto* const item = new QListWidgetItem(text, list_);
  item->setFlags(Qt::NoItemFlags);
  item->setSizeHint(QSize(0, kHeading_px));
  QFont font = list_->font();
  font.setWeight(QFont::DemiBold);
  item->setFont(font);
  headings_.push_back(item);
  return item;
}

// Headings cannot be selected, so the style would draw them grey.
void SideBar::colourHeadings() {
  for (QListWidgetItem* const item : headings_)
    item->setForeground(item == reason_ ? theme().faint_text : theme().text);
}

void SideBar::changeEvent(QEvent* event) {
  QFrame::changeEvent(event);
  if (event->type() != QEvent::PaletteChange) return;
  colourHeadings();
  if (verdict_) setVerdict(verdict_->first, verdict_->second);
}

void SideBar::foldMore(bool folded) {
  folded_ = folded;
  more_->setIcon(icon(folded ? "right" : "down"));
  more_->setData(Qt::AccessibleTextRole, folded ? tr("More, folded") : tr("More, open"));
  for (std::size_t i = 0; i < pages_.size(); ++i)
    if (pages_[i].group == PageGroup::More) items_[i]->setHidden(folded);
  fitHeight();
}

void SideBar::fitHeight() {
  constexpr int kAround_px = 16;
  int height_px = kAround_px;
  for (int row = 0; row < list_->count(); ++row)
    if (const QListWidgetItem* const item = list_->item(row); !item->isHidden())
      height_px += item->sizeHint().height() + 2;
  list_->setMaximumHeight(height_px);
  list_->updateGeometry();
}

void SideBar::showPage(int page) {
  const auto index = static_cast<std::size_t>(page);
  if (pages_[index].group == PageGroup::More && folded_) foldMore(false);
  list_->setCurrentItem(items_[index]);
}

void SideBar::setReasons(const std::vector<QString>& reasons, const QString& recording) {
  for (std::size_t i = 0; i < items_.size(); ++i) {
    items_[i]->setFlags(reasons[i].isEmpty() ? Qt::ItemIsEnabled | Qt::ItemIsSelectable : Qt::NoItemFlags);
    const QString key = keyOfPage(i).toString(QKeySequence::NativeText);
    items_[i]->setToolTip(reasons[i].isEmpty() ? tr("%1 (%2)").arg(pages_[i].title, key) : reasons[i]);
  }
  const auto first =
      std::find_if(reasons.begin(), reasons.end(), [](const QString& reason) { return !reason.isEmpty(); });
  // The line stays: pages must not move under the mouse when a run starts.
  reason_->setText(first == reasons.end() ? recording : *first);
  reason_->setToolTip(reason_->text());
}

void SideBar::setVerdict(int page, std::optional<CalibrationStatus> status) {
  const PageEntry& entry = pages_[static_cast<std::size_t>(page)];
  QListWidgetItem& item = *items_[static_cast<std::size_t>(page)];
  verdict_ = {page, status};
  item.setIcon(status ? verdictIcon(*status) : icon(entry.icon_name));
  item.setText(status ? tr("%1: %2").arg(entry.title, QString::fromLatin1(statusName(*status)))
                      : entry.title);
}

}  // namespace evical::ui
