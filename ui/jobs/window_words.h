// SPDX-License-Identifier: GPL-3.0-or-later
// Messages of core speak of session files and commands; the window has forms and pages.
#pragma once

#include <QString>
#include <QStringList>

namespace evical::ui {

QString inWindowWords(QString text);

// The pieces of core's messages that are replaced.
QStringList piecesOfCoresMessages();

}  // namespace evical::ui
