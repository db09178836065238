// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/forms/page_keys.h"

#include <QAbstractButton>
#include <QAbstractSpinBox>
#include <QApplication>
#include <QKeyEvent>
#include <QLineEdit>
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

namespace evical::ui {
namespace {

// Input field of a spin box.
const QLineEdit* fieldOf(QObject* widget) {
  if (const auto* const field = qobject_cast<const QLineEdit*>(widget)) return field;
  const auto* const box = qobject_cast<const QAbstractSpinBox*>(widget);
  return box != nullptr ? box->findChild<const QLineEdit*>() : nullptr;
}

}  // namespace

bool SessionUndoKeys::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() != QEvent::ShortcutOverride) return false;
  const auto* const key = dynamic_cast<const QKeyEvent*>(event);
  const QLineEdit* const field = fieldOf(watched);
  if (key == nullptr || field == nullptr) return false;
  const bool undo = key->matches(QKeySequence::Undo) && !field->isUndoAvailable();
  const bool redo = key->matches(QKeySequence::Redo) && !field->isRedoAvailable();
  if (!undo && !redo) return false;
  event->ignore();  // so it becomes a shortcut
  return true;
}

}  // namespace evical::ui
