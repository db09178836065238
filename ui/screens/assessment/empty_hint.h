// SPDX-License-Identifier: GPL-3.0-or-later
// Text in the middle of a page that has no result yet.
#pragma once

class QString;
class QWidget;

namespace evical::ui {

QWidget* emptyHint(const QString& text, QWidget* parent);

}  // namespace evical::ui
