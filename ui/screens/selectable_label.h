// A wrapped text in one of the theme's roles, whose words can be selected and copied.
#pragma once

#include <QLabel>
#include <QString>

namespace evical::ui {

inline QLabel* selectableLabel(const char* role, const QString& text, QWidget* parent) {
  auto* const label = new QLabel(text, parent);
  label->setProperty("role", role);
  label->setWordWrap(true);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  return label;
}
inline QLabel* selectableLabel(const char* role, QWidget* parent) {
  return selectableLabel(role, QString(), parent);
}

}  // namespace evical::ui
