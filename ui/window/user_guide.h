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
