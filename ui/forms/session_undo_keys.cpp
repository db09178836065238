// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/forms/session_undo_keys.h"

#include <QAbstractSpinBox>
#include <QKeyEvent>
#include <QLineEdit>

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
