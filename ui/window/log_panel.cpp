// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/log_panel.h"

#include "ui/theme/theme.h"

#include <QApplication>
#include <QClipboard>
#include <QComboBox>
#include <QEvent>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QToolButton>
#include <QVBoxLayout>

namespace evical::ui {
namespace {

constexpr std::size_t kMaxLines = 5000;
constexpr int kMinText_px = 40;  // two lines: the dock must not enlarge the window beyond small displays

QColor colourOf(LogLevel level) {
  switch (level) {
    case LogLevel::Debug:
      return theme().faint_text;
    case LogLevel::Info:
      return theme().text;
    case LogLevel::Warning:
      return theme().warning;
  }
  return theme().text;
}

}  // namespace

LogPanel::LogPanel(QWidget* parent)
    : QWidget(parent),
      level_(new QComboBox(this)),
      search_(new QLineEdit(this)),
      text_(new QPlainTextEdit(this)) {
  level_->addItem(tr("Everything"), static_cast<int>(LogLevel::Debug));
  level_->addItem(tr("Info and warnings"), static_cast<int>(LogLevel::Info));
  level_->addItem(tr("Warnings"), static_cast<int>(LogLevel::Warning));
  level_->setCurrentIndex(1);
  level_->setAccessibleName(tr("Level of the messages"));
  search_->setAccessibleName(tr("Filter of messages"));
  text_->setAccessibleName(tr("Messages"));
  level_->setToolTip(tr("Show messages of this level and above"));
  search_->setPlaceholderText(tr("Filter"));
  search_->setClearButtonEnabled(true);
  search_->setToolTip(tr("Show only messages that contain this text"));
  text_->setReadOnly(true);
  text_->setMinimumHeight(kMinText_px);
  text_->setMaximumBlockCount(static_cast<int>(kMaxLines));
  text_->setPlaceholderText(tr("Messages of calibrations are shown here"));
  auto* const copy = new QToolButton(this);
  copy->setIcon(icon("copy"));
  copy->setAccessibleName(tr("Copy the messages"));
  copy->setToolTip(tr("Copy the shown messages"));
  connect(copy, &QToolButton::clicked, this, [this] { QApplication::clipboard()->setText(shownText()); });
  connect(level_, &QComboBox::currentIndexChanged, this, &LogPanel::refill);
  connect(search_, &QLineEdit::textChanged, this, &LogPanel::refill);

  auto* const bar = new QHBoxLayout;
  bar->addWidget(level_);
  bar->addWidget(search_, 1);
  bar->addWidget(copy);
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(8, 6, 8, 6);
  layout->addLayout(bar);
  layout->addWidget(text_);
}

void LogPanel::addHeading(const QString& title) {
  add({LogLevel::Warning, -1.0, title});
}

void LogPanel::add(const LogLine& line) {
  lines_.push_back(line);
  if (lines_.size() > kMaxLines) lines_.pop_front();
  if (isShown(line)) append(line);
}

bool LogPanel::isShown(const LogLine& line) const {
  return static_cast<int>(line.level) >= level_->currentData().toInt() &&
         line.text.contains(search_->text(), Qt::CaseInsensitive);
}

void LogPanel::append(const LogLine& line) {
  const bool heading = line.time_s < 0.0;
  const QString colour = (heading ? theme().accent : colourOf(line.level)).name();
  const QString time = heading ? QString() : QString::asprintf("%8.2f s  ", line.time_s);
  text_->appendHtml(QString("<span style=\"white-space: pre-wrap; color: %1\">%2%3</span>")
                        .arg(colour, time, line.text.toHtmlEscaped()));
}

void LogPanel::refill() {
  text_->clear();
  for (const LogLine& line : lines_)
    if (isShown(line)) append(line);
}

QString LogPanel::shownText() const {
  return text_->toPlainText();
}

void LogPanel::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) refill();
  QWidget::changeEvent(event);
}

}  // namespace evical::ui
