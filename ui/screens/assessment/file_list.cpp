// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/file_list.h"

#include "ui/theme/theme.h"

#include <QDir>
#include <QDragEnterEvent>
#include <QHBoxLayout>
#include <QListWidget>
#include <QMimeData>
#include <QPainter>
#include <QPushButton>
#include <QSet>
#include <QShortcut>

namespace evical::ui {
namespace {

QStringList localFiles(const QMimeData& data) {
  QStringList files;
  for (const QUrl& url : data.urls())
    if (url.isLocalFile()) files << url.toLocalFile();
  return files;
}

// Says what belongs into it while it is empty.
class DroppedList final : public QListWidget {
 public:
  using QListWidget::QListWidget;

 protected:
  void paintEvent(QPaintEvent* event) override {
    QListWidget::paintEvent(event);
    if (count() > 0) return;
    QPainter painter(viewport());
    painter.setPen(palette().color(QPalette::PlaceholderText));
    painter.drawText(viewport()->rect(), Qt::AlignCenter,
                     FileList::tr("%1: add them, or drop them here").arg(accessibleName()));
  }
};

}  // namespace

FileList::FileList(const QString& things, const QString& title, const QString& tip, QWidget* parent)
    : QWidget(parent),
      list_(new DroppedList(this)),
      remove_(new QPushButton(icon("remove"), tr("Remove"), this)),
      buttons_(new QVBoxLayout) {
  list_->setObjectName("list_" + things);
  list_->setAccessibleName(title);
  list_->setToolTip(tip);
  list_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  list_->setTextElideMode(Qt::ElideMiddle);
  list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  list_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Ignored);  // as high as the buttons
  list_->setMinimumHeight(0);
  setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
  setAcceptDrops(true);
  auto* const add = new QPushButton(icon("open"), tr("Add..."), this);
  add->setObjectName("add_" + things);
  add->setToolTip(tip);
  remove_->setObjectName("remove_" + things);
  remove_->setToolTip(tr("Remove the selected entries from the list; the files are kept (Delete)"));
  connect(add, &QPushButton::clicked, this, &FileList::addRequested);
  connect(remove_, &QPushButton::clicked, this, &FileList::removeChosen);
  connect(list_, &QListWidget::itemSelectionChanged, this, &FileList::offer);
  auto* const remove_key = new QShortcut(QKeySequence::Delete, list_);
  remove_key->setContext(Qt::WidgetShortcut);
  connect(remove_key, &QShortcut::activated, this, &FileList::removeChosen);
  buttons_->setSpacing(4);
  buttons_->addWidget(add);
  buttons_->addWidget(remove_);
  buttons_->addStretch();
  auto* const layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(list_, 1);
  layout->addLayout(buttons_);
  offer();
}

void FileList::insertButton(QPushButton* button) {
  buttons_->insertWidget(1, button);
}

QStringList FileList::files() const {
  QStringList all;
  for (int row = 0; row < list_->count(); ++row) all << list_->item(row)->data(Qt::UserRole).toString();
  return all;
}

void FileList::add(const QStringList& files) {
  const QStringList listed = this->files();
  QSet<QString> known(listed.begin(), listed.end());
  for (const QString& file : files) {
    if (file.isEmpty() || known.contains(file)) continue;
    known.insert(file);
    const bool session = file.endsWith(".yaml") || file.endsWith(".yml");
    auto* const item =
        new QListWidgetItem(icon(session ? "open" : "recording"), QDir::toNativeSeparators(file), list_);
    item->setData(Qt::UserRole, file);
    item->setToolTip(item->text());
  }
  offer();
  emit changed();
}

void FileList::removeChosen() {
  qDeleteAll(list_->selectedItems());
  offer();
  emit changed();
}

void FileList::offer() {
  remove_->setEnabled(!list_->selectedItems().isEmpty());
}

void FileList::dragEnterEvent(QDragEnterEvent* event) {
  if (!localFiles(*event->mimeData()).isEmpty()) event->acceptProposedAction();
}

void FileList::dropEvent(QDropEvent* event) {
  add(localFiles(*event->mimeData()));
  event->acceptProposedAction();
}

}  // namespace evical::ui
