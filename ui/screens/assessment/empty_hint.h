// SPDX-License-Identifier: GPL-3.0-or-later
// What a page says in its middle while it has found nothing yet.
#pragma once

class QString;
class QWidget;

namespace evical::ui {

QWidget* emptyHint(const QString& text, QWidget* parent);

}  // namespace evical::ui
