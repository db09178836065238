// SPDX-License-Identifier: GPL-3.0-or-later
// Button that folds and unfolds what is below it.
#pragma once

#include "ui/theme/theme.h"

#include <QToolButton>

namespace evical::ui {

// Checked: unfolded. The receiver shows and hides the widgets when it is toggled.
inline QToolButton* foldButton(const char* name, const QString& text, const QString& tip, QWidget* parent) {
  auto* const button = new QToolButton(parent);
  button->setObjectName(name);
  button->setText(text);
  button->setToolTip(tip);
  button->setCheckable(true);
  button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  button->setFocusPolicy(Qt::StrongFocus);
  button->setIcon(icon("right"));
  QObject::connect(button, &QToolButton::toggled, button,
                   [button](bool open) { button->setIcon(icon(open ? "down" : "right")); });
  return button;
}

}  // namespace evical::ui
