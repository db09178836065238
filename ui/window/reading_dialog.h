// SPDX-License-Identifier: GPL-3.0-or-later
// A dialog that is read beside the work: not modal, and nothing stands in front of a running job.
#pragma once

class QDialog;
class QString;
class QWidget;

namespace evical::ui {

// Of this name, with an empty column; deleted when it is closed.
QDialog* makeReadingDialog(QWidget* window, const QString& name, const QString& title);

// Below all else that was added.
void addCloseButton(QDialog* dialog);

// True if it is open already; then it comes to the front.
bool raiseOpened(QWidget* window, const QString& name);

}  // namespace evical::ui
