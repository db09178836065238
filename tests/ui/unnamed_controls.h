// SPDX-License-Identifier: GPL-3.0-or-later
// Controls of a window without a name for screen readers, according to Qt's accessibility.
#pragma once

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QAccessible>
#include <QComboBox>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QScrollBar>
#include <QTextEdit>
#include <QWidget>

namespace evical::ui::test {

inline bool isControl(const QWidget& widget) {
  const auto is = [&](auto* type) {
    return qobject_cast<std::remove_reference_t<decltype(*type)>*>(&widget);
  };
  if (is(static_cast<const QScrollBar*>(nullptr))) return false;  // of an area that has a name
  return is(static_cast<const QAbstractButton*>(nullptr)) || is(static_cast<const QLineEdit*>(nullptr)) ||
         is(static_cast<const QComboBox*>(nullptr)) || is(static_cast<const QAbstractSpinBox*>(nullptr)) ||
         is(static_cast<const QAbstractSlider*>(nullptr)) ||
         is(static_cast<const QAbstractItemView*>(nullptr)) || is(static_cast<const QTextEdit*>(nullptr)) ||
         is(static_cast<const QPlainTextEdit*>(nullptr)) ||
         (widget.focusPolicy() & Qt::TabFocus && widget.metaObject()->className()[0] != 'Q');
}

// Parts that Qt creates: editors of spin boxes, lists of combo boxes, headers, buttons of tab bars.
inline bool isPartOfAnother(const QWidget& widget) {
  if (widget.objectName().startsWith("qt_")) return true;
  for (const QWidget* parent = widget.parentWidget(); parent; parent = parent->parentWidget()) {
    const QByteArray name = parent->metaObject()->className();
    if (name == "QComboBoxPrivateContainer" || name == "QTabBar" || name == "QCalendarWidget") return true;
    if (qobject_cast<const QAbstractSpinBox*>(parent) || qobject_cast<const QComboBox*>(parent)) return true;
    if (const auto* field = qobject_cast<const QLineEdit*>(parent)) return field != &widget;
    if (parent->isWindow()) break;
  }
  const QByteArray name = widget.metaObject()->className();
  return name == "QHeaderView" || name == "QTableCornerButton";
}

// "ResultScreen > QTreeWidget 'name'": only our own classes on the path, since messages of tests are
// truncated.
inline QString pathOf(const QWidget& widget) {
  QString path = QString("%1 '%2'").arg(widget.metaObject()->className(), widget.objectName());
  for (const QWidget* at = widget.parentWidget(); at && !at->isWindow(); at = at->parentWidget())
    if (QByteArray(at->metaObject()->className()).startsWith("evical"))
      path.prepend(QString(at->metaObject()->className()).section("::", -1) + " > ");
  return path.remove("evical::ui::");
}

inline QStringList unnamedControls(const QWidget& root) {
  QStringList found;
  for (QWidget* const widget : root.findChildren<QWidget*>()) {
    if (!isControl(*widget) || isPartOfAnother(*widget)) continue;
    QAccessibleInterface* const interface = QAccessible::queryAccessibleInterface(widget);
    if (interface && !interface->text(QAccessible::Name).trimmed().isEmpty()) continue;
    found << pathOf(*widget);
  }
  return found;
}

}  // namespace evical::ui::test
