// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of the guide: of the pages, as in the documentation, and of the motions, drawn like the
// animations.
#pragma once

#include <QString>
#include <QStringList>

class QTextDocument;

namespace evical::ui {

// The guide for the program's dialog: embedded pictures with their titles, drawn motions, and no links to other pages.
QString withPictures(const QString& markdown);

// Adds the pictures that the guide refers to, at this width.
void addGuidePictures(QTextDocument& document, int width_px, double pixel_ratio);
QStringList guidePictures();  // names of the embedded pictures

}  // namespace evical::ui
