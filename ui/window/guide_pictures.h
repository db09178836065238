// SPDX-License-Identifier: GPL-3.0-or-later
// The guide's pictures: of the pages, as the documentation has them, and of the motions, drawn as they are shown.
#pragma once

#include <QString>
#include <QStringList>

class QTextDocument;

namespace evical::ui {

// The guide with its pictures: where a part has some, they stand below its text.
QString withPictures(const QString& markdown);

// What the guide with pictures names, at this width.
void addGuidePictures(QTextDocument& document, int width_px, double pixel_ratio);
QStringList guidePictures();  // the names

}  // namespace evical::ui
