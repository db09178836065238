// SPDX-License-Identifier: GPL-3.0-or-later
// What a screen shows while it has nothing to show: a sentence in its middle.
#pragma once

#include <QString>

class QStackedLayout;
class QWidget;

namespace evical::ui {

// Of a page that shows runs: there is none, or one is being made.
QString noRunNote(bool calibrating);

// Stacks the note (index 0) and the content (index 1) in `screen`; the note is in front.
enum class StackPage { Note = 0, Content = 1 };
QStackedLayout* stackWithNote(QWidget& screen, QWidget* content, const QString& note);
void setNote(QStackedLayout& stack, const QString& note);
void showPage(QStackedLayout& stack, StackPage page);

}  // namespace evical::ui
