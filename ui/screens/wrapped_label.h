// Labels with wrapped text in a role of the theme.
#pragma once

#include <QLabel>
#include <QString>

namespace evical::ui {

inline QLabel* wrappedLabel(const QString& text, const char* role, QWidget* parent) {
  auto* const label = new QLabel(text, parent);
  label->setProperty("role", role);
  label->setWordWrap(true);
  return label;
}

// Text that can be selected and copied.
inline QLabel* selectableLabel(const char* role, const QString& text, QWidget* parent) {
  QLabel* const label = wrappedLabel(text, role, parent);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  return label;
}
inline QLabel* selectableLabel(const char* role, QWidget* parent) {
  return selectableLabel(role, QString(), parent);
}

}  // namespace evical::ui
