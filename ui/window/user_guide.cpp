// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/user_guide.h"

#include "ui/window/guide_pictures.h"
#include "ui/window/reading_dialog.h"

#include <QAbstractTextDocumentLayout>
#include <QDialog>
#include <QFile>
#include <QListWidget>
#include <QScrollBar>
#include <QSplitter>
#include <QStyledItemDelegate>
#include <QTextBlock>
#include <QTextBrowser>
#include <QTextCursor>
#include <QUrl>
#include <QVBoxLayout>

namespace evical::ui {
namespace {

constexpr double kMargin_px = 18.0;

QTextBrowser* makeBrowser(const QString& name, QWidget* parent) {
  auto* const browser = new QTextBrowser(parent);
  browser->setObjectName(name);
  browser->setAccessibleName(QObject::tr("Text of the guide"));
  browser->setOpenExternalLinks(true);
  browser->document()->setDocumentMargin(kMargin_px);
  return browser;
}

void scrollTo(QTextBrowser& browser, int block) {
  const QTextBlock heading = browser.document()->findBlockByNumber(block);
  const double top_px = browser.document()->documentLayout()->blockBoundingRect(heading).top();
  browser.verticalScrollBar()->setValue(static_cast<int>(top_px));
}

// Rows as wide as the list: a longer heading ends with dots, and the list does not scroll sideways.
class HeadingDelegate final : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;
  QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    return {1, QStyledItemDelegate::sizeHint(option, index).height()};
  }
};

// Parts of the guide, as links.
QListWidget* makeContents(QTextBrowser* browser, QWidget* parent) {
  auto* const contents = new QListWidget(parent);
  contents->setObjectName("contents");
  contents->setAccessibleName(QObject::tr("Contents"));
  contents->setItemDelegate(new HeadingDelegate(contents));
  contents->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  for (QTextBlock block = browser->document()->begin(); block.isValid(); block = block.next()) {
    const int level = block.blockFormat().headingLevel();
    if (level < 2) continue;
    auto* const entry = new QListWidgetItem(block.text(), contents);
    entry->setData(Qt::UserRole, block.blockNumber());
    entry->setToolTip(block.text());
    if (level > 2) continue;
    QFont font = contents->font();
    font.setBold(true);
    entry->setFont(font);
  }
  QObject::connect(contents, &QListWidget::currentItemChanged, browser, [browser](QListWidgetItem* entry) {
    if (entry != nullptr) scrollTo(*browser, entry->data(Qt::UserRole).toInt());
  });
  return contents;
}

QString wholeGuide() {
  QFile file(":/user_guide.md");
  return file.open(QIODevice::ReadOnly) ? QString::fromUtf8(file.readAll()) : QString();
}

// Part with this heading, up to the next one.
QString partOfGuide(const QString& heading) {
  const QString all = wholeGuide();
  const qsizetype begin = all.indexOf("\n## " + heading + '\n');
  return begin < 0 ? QString() : all.mid(begin, all.indexOf("\n## ", begin + 1) - begin);
}

}  // namespace

void showUserGuide(QWidget* window) {
  constexpr int kWidth_px = 980, kHeight_px = 720, kContents_px = 220, kPicture_px = 660;
  if (raiseOpened(window, "user_guide")) return;
  QDialog* const dialog = makeReadingDialog(window, "user_guide", QObject::tr("User guide"));
  auto* const parts = new QSplitter(dialog);
  QTextBrowser* const browser = makeBrowser("guide", parts);
  browser->document()->setMarkdown(withPictures(wholeGuide()));  // discards earlier pictures
  addGuidePictures(*browser->document(), kPicture_px, dialog->devicePixelRatioF());
  browser->document()->markContentsDirty(0, browser->document()->characterCount());
  browser->moveCursor(QTextCursor::Start);  // setMarkdown leaves it at the end, which scrolls the view
  parts->insertWidget(0, makeContents(browser, parts));
  parts->setSizes({kContents_px, kWidth_px - kContents_px});
  parts->setStretchFactor(1, 1);
  parts->setChildrenCollapsible(false);
  dialog->layout()->addWidget(parts);
  addCloseButton(dialog);
  dialog->resize(kWidth_px, kHeight_px);
  dialog->show();
}

void showKeys(QWidget* window) {
  constexpr int kWidth_px = 620, kHeight_px = 640;
  if (raiseOpened(window, "keys")) return;
  QDialog* const dialog = makeReadingDialog(window, "keys", QObject::tr("Keyboard"));
  QTextBrowser* const browser = makeBrowser("guide", dialog);
  browser->document()->setMarkdown(partOfGuide("Keys"));
  dialog->layout()->addWidget(browser);
  addCloseButton(dialog);
  dialog->resize(kWidth_px, kHeight_px);
  dialog->show();
}

}  // namespace evical::ui
