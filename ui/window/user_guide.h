// SPDX-License-Identifier: GPL-3.0-or-later
// F1: dialog with the embedded guide and its contents. "?": its last part, the keys.
#pragma once

#include <QString>
#include <QStringList>

class QWidget;
class QTextDocument;

namespace evical::ui {

// Raised if already open.
void showUserGuide(QWidget* window);
void showKeys(QWidget* window);

// Pictures of the guide: of the pages, as in the documentation, and of the motions, drawn like the
// animations.

// The guide for the program's dialog: embedded pictures with their titles, drawn motions, and no links to
// other pages.
QString withPictures(const QString& markdown);

// Adds the pictures that the guide refers to, at this width.
void addGuidePictures(QTextDocument& document, int width_px, double pixel_ratio);
QStringList guidePictures();  // names of the embedded pictures

}  // namespace evical::ui

// Dialog for reading, not modal, so that it never blocks a running job.

class QDialog;
class QString;

namespace evical::ui {

// Creates a dialog of this name with an empty column; deleted when closed.
QDialog* makeReadingDialog(QWidget* window, const QString& name, const QString& title);

// Call after everything else has been added: the button goes to the bottom.
void addCloseButton(QDialog* dialog);

// If the dialog is already open, raises it and returns true.
bool raiseOpened(QWidget* window, const QString& name);

}  // namespace evical::ui
