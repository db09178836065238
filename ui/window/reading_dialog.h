// SPDX-License-Identifier: GPL-3.0-or-later
// Dialog for reading, not modal, so that it never blocks a running job.
#pragma once

class QDialog;
class QString;
class QWidget;

namespace evical::ui {

// Creates a dialog of this name with an empty column; deleted when closed.
QDialog* makeReadingDialog(QWidget* window, const QString& name, const QString& title);

// Call after everything else has been added: the button goes to the bottom.
void addCloseButton(QDialog* dialog);

// If the dialog is already open, raises it and returns true.
bool raiseOpened(QWidget* window, const QString& name);

}  // namespace evical::ui
