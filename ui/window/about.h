// SPDX-License-Identifier: GPL-3.0-or-later
// What this program is, which build, and under which licences, with their texts.
#pragma once

class QString;
class QWidget;

namespace evical::ui {

void showAbout(QWidget* window, const QString& version);

}  // namespace evical::ui
