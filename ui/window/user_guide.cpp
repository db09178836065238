// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/user_guide.h"

#include "ui/screens/recording/motion_picture.h"

#include <QAbstractTextDocumentLayout>
#include <QDialog>
#include <QDialogButtonBox>
#include <QDir>
#include <QFile>
#include <QImage>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPixmap>
#include <QPushButton>
#include <QRegularExpression>
#include <QScrollBar>
#include <QShortcut>
#include <QSplitter>
#include <QStyledItemDelegate>
#include <QTextBlock>
#include <QTextBrowser>
#include <QTextCursor>
#include <QTextDocument>
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

// Marks all places of the text, shows their number, and moves to the next one after `from`.
void findInGuide(QTextBrowser& browser, QLabel& count, const QString& text, int from) {
  QList<QTextEdit::ExtraSelection> places;
  QTextCursor next;
  QColor pale = browser.palette().color(QPalette::Highlight);
  pale.setAlphaF(0.3F);
  for (QTextCursor at = browser.document()->find(text, 0); !text.isEmpty() && !at.isNull();
       at = browser.document()->find(text, at)) {
    QTextCharFormat marked;
    marked.setBackground(pale);
    places.append({at, marked});
    if (next.isNull() && at.selectionStart() >= from) next = at;
  }
  if (next.isNull() && !places.isEmpty()) next = places.front().cursor;  // after the last one, the first
  browser.setExtraSelections(places);
  count.setText(text.isEmpty()       ? QString()
                : places.size() == 1 ? QObject::tr("1 match")
                                     : QObject::tr("%1 matches").arg(places.size()));
  if (next.isNull()) return;
  browser.setTextCursor(next);
  browser.ensureCursorVisible();
}

// Field above the contents; Return goes to the next place.
QWidget* makeSearch(QTextBrowser* browser, QWidget* parent) {
  auto* const search = new QWidget(parent);
  auto* const field = new QLineEdit(search);
  auto* const count = new QLabel(search);
  field->setObjectName("guide_search");
  field->setAccessibleName(QObject::tr("Search the guide"));
  field->setPlaceholderText(QObject::tr("Search (Ctrl+F)"));
  field->setClearButtonEnabled(true);
  count->setObjectName("guide_matches");
  count->setProperty("role", "hint");
  const auto find = [browser, field, count](int from) { findInGuide(*browser, *count, field->text(), from); };
  QObject::connect(field, &QLineEdit::textChanged, browser,
                   [browser, find] { find(browser->textCursor().selectionStart()); });
  QObject::connect(field, &QLineEdit::returnPressed, browser,
                   [browser, find] { find(browser->textCursor().selectionEnd()); });
  auto* const key = new QShortcut(QKeySequence::Find, parent);
  QObject::connect(key, &QShortcut::activated, field, [field] {
    field->setFocus();
    field->selectAll();
  });
  auto* const layout = new QVBoxLayout(search);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(field);
  layout->addWidget(count);
  return search;
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
  auto* const left = new QWidget(parts);
  auto* const column = new QVBoxLayout(left);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(makeSearch(browser, dialog));
  column->addWidget(makeContents(browser, left));
  parts->insertWidget(0, left);
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

namespace {

constexpr const char *kMotionsPart = "Before you record", *kMotion = "motion-";
constexpr double kMotionShape = 0.5;  // height by width

QString urlOf(const QString& name) {
  return "picture:" + name;
}

QString motions() {
  QString text = "\n### How to move\n\n";
  for (const ShownMotion& motion : shownMotions())
    text += QString("**%1.** %2\n").arg(motion.title, motion.words) +
            QString("\n![%1](%2)\n\n").arg(motion.title, urlOf(kMotion + motion.name));
  return text;
}

QImage fileOf(const QString& name, int width_px, double pixel_ratio) {
  const QImage whole(QString(":/pictures/%1.png").arg(name));
  QImage scaled = whole.scaledToWidth(static_cast<int>(width_px * pixel_ratio), Qt::SmoothTransformation);
  scaled.setDevicePixelRatio(pixel_ratio);
  return scaled;
}

QImage drawingOf(const ShownMotion& motion, int width_px, double pixel_ratio) {
  MotionPicture drawn;
  drawn.resize(width_px, static_cast<int>(kMotionShape * width_px));
  drawn.setMotion(motion);
  QImage image(drawn.size() * pixel_ratio, QImage::Format_ARGB32_Premultiplied);
  image.setDevicePixelRatio(pixel_ratio);
  image.fill(Qt::transparent);
  drawn.render(&image);
  return image;
}

}  // namespace

QString withPictures(const QString& markdown) {
  static const QRegularExpression picture(R"(^!\[([^\]]*)\]\(pictures/([\w-]+)\.png\)$)");
  static const QRegularExpression link(R"((?<!!)\[([^\]]*)\]\([^)]*\))");  // to a page of the documentation
  QString all, part;
  for (const QString& line : markdown.split('\n')) {
    if (line.startsWith("## ")) {
      if (part == kMotionsPart) all += motions() + '\n';
      part = line.mid(3).trimmed();
    }
    if (const QRegularExpressionMatch found = picture.match(line); found.hasMatch())
      all += QString("![%1](%2)\n\n*%1*\n").arg(found.captured(1), urlOf(found.captured(2)));
    else
      all += QString(line).replace(link, "\\1") + '\n';
  }
  return all;
}

QStringList guidePictures() {
  return QDir(":/pictures").entryList().replaceInStrings(".png", "");
}

void addGuidePictures(QTextDocument& document, int width_px, double pixel_ratio) {
  const auto add = [&](const QString& name, const QImage& image) {
    document.addResource(QTextDocument::ImageResource, QUrl(urlOf(name)), image);
  };
  for (const QString& name : guidePictures()) add(name, fileOf(name, width_px, pixel_ratio));
  for (const ShownMotion& motion : shownMotions())
    add(kMotion + motion.name, drawingOf(motion, width_px, pixel_ratio));
}

QDialog* makeReadingDialog(QWidget* window, const QString& name, const QString& title) {
  auto* const dialog = new QDialog(window);
  dialog->setObjectName(name);
  dialog->setWindowTitle(title);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  new QVBoxLayout(dialog);
  return dialog;
}

void addCloseButton(QDialog* dialog) {
  auto* const buttons = new QDialogButtonBox(QDialogButtonBox::Close, dialog);
  QObject::connect(buttons, &QDialogButtonBox::rejected, dialog, &QDialog::close);
  buttons->button(QDialogButtonBox::Close)->setAutoDefault(false);  // Return belongs to the fields
  dialog->layout()->addWidget(buttons);
}

bool raiseOpened(QWidget* window, const QString& name) {
  auto* const dialog = window->findChild<QDialog*>(name);
  if (dialog == nullptr) return false;
  dialog->raise();
  dialog->activateWindow();
  return true;
}

}  // namespace evical::ui
