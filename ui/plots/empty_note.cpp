// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/plots/empty_note.h"

#include <QLabel>
#include <QStackedLayout>

namespace evical::ui {

QStackedLayout* stackWithNote(QWidget& screen, QWidget* content, const QString& note) {
  auto* const label = new QLabel(note);
  label->setAlignment(Qt::AlignCenter);
  label->setWordWrap(true);
  label->setForegroundRole(QPalette::PlaceholderText);
  QFont font = label->font();
  font.setPointSizeF(1.2 * font.pointSizeF());
  label->setFont(font);
  auto* const stack = new QStackedLayout(&screen);
  stack->addWidget(label);
  stack->addWidget(content);
  return stack;
}

QString noRunNote(bool calibrating) {
  return calibrating ? QObject::tr("Calibrating: this page is filled when the run is done.")
                     : QObject::tr("No calibration yet: press Calibrate.");
}

void setNote(QStackedLayout& stack, const QString& note) {
  qobject_cast<QLabel*>(stack.widget(static_cast<int>(StackPage::Note)))->setText(note);
}

void showPage(QStackedLayout& stack, StackPage page) {
  stack.setCurrentIndex(static_cast<int>(page));
}

}  // namespace evical::ui
