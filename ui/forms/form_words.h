// SPDX-License-Identifier: GPL-3.0-or-later
// Messages of core in the words of the forms: they have labels and millimetres, a session file has keys and
// metres.
#pragma once

#include <QString>

namespace evical::ui {

// "board.spacing_m: 0.05" becomes "spacing 50 mm", "spacing 0.05 m" becomes "spacing 50 mm".
QString inFormWords(QString text);

}  // namespace evical::ui
