// SPDX-License-Identifier: GPL-3.0-or-later
// How charts are saved: the same entries in the context menu of each and in the menu of a page's button.
#pragma once

#include <QString>

class QMenu;
class QToolButton;
class QWidget;

namespace evical::ui {

class FileSaver;
class PlotPanel;

void addSaveActions(QMenu& menu, PlotPanel& panel, FileSaver& saver);

// Offers the charts of `page` that can be seen now: all in one picture, and each by itself.
QToolButton* makeSaveButton(QWidget& page, const QString& name);

}  // namespace evical::ui
