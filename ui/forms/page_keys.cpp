// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/forms/page_keys.h"

#include <QAbstractButton>
#include <QApplication>
#include <QShortcut>

#include <utility>

namespace evical::ui {

void addPageKey(QWidget* page, const QKeySequence& key, std::function<void()> act) {
  auto* const shortcut = new QShortcut(key, page);  // window-wide; shortcuts of hidden pages are inactive
  const bool presses_buttons = key == QKeySequence(Qt::Key_Space);
  QObject::connect(shortcut, &QShortcut::activated, page, [act = std::move(act), presses_buttons] {
    auto* const button = qobject_cast<QAbstractButton*>(QApplication::focusWidget());
    if (presses_buttons && button != nullptr && button->isEnabled()) return button->click();
    act();
  });
}

void leaveFocusToKeys(QWidget* page) {
  for (QAbstractButton* const button : page->findChildren<QAbstractButton*>())
    button->setFocusPolicy(Qt::TabFocus);
}

}  // namespace evical::ui
