// SPDX-License-Identifier: GPL-3.0-or-later
// Sentence in the middle of a screen without content.
#pragma once

#include <QString>

class QStackedLayout;
class QWidget;

namespace evical::ui {

// For a page that shows runs: there is none yet, or one is in progress.
QString noRunNote(bool calibrating);

// Stacks the note (index 0) and the content (index 1) in `screen`; the note is in front.
enum class StackPage { Note = 0, Content = 1 };
QStackedLayout* stackWithNote(QWidget& screen, QWidget* content, const QString& note);
void setNote(QStackedLayout& stack, const QString& note);
void showPage(QStackedLayout& stack, StackPage page);

}  // namespace evical::ui
