// SPDX-License-Identifier: GPL-3.0-or-later
// Messages of core speak of session files and commands; the window has forms and pages.
#pragma once

#include <QString>

namespace evical::ui {

QString inWindowWords(QString text);

}  // namespace evical::ui
