// SPDX-License-Identifier: GPL-3.0-or-later
// Row for a file or folder in a form: typed, dropped, or chosen in a dialog that the receiver opens.
#pragma once

#include <QWidget>

class QGridLayout;
class QLabel;
class QLineEdit;
class QMenu;
class QPushButton;

namespace evical::ui {

class PathRow : public QObject {
  Q_OBJECT

 public:
  // Three cells of `grid`: label, field, button. `title` includes the label's shortcut.
  PathRow(const QString& object_name, const QString& title, const QString& tip, QGridLayout& grid,
          QWidget* parent);

  QString path() const;
  void setPath(const QString& path);      // like an edit of the user
  void proposePath(const QString& path);  // unless the user has set one
  void setMenu(QMenu* menu);              // of the button, instead of the dialog
  void setPlaceholder(const QString& text);
  void setEnabled(bool enabled);

 signals:
  void chooseRequested();
  void changed();

 private:
  QLineEdit* field_;
  QPushButton* choose_;
  bool by_hand_ = false;
};

}  // namespace evical::ui
