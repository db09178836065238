// SPDX-License-Identifier: GPL-3.0-or-later
// Saving of charts: the same entries in each chart's context menu and in the menu of a page's button.
#pragma once

#include <QString>

class QMenu;
class QToolButton;
class QWidget;

namespace evical::ui {

class FileSaver;
class PlotPanel;

void addSaveActions(QMenu& menu, PlotPanel& panel, FileSaver& saver);

// Offers the visible charts of `page`: all in one picture, and each separately.
QToolButton* makeSaveButton(QWidget& page, const QString& name);

}  // namespace evical::ui
