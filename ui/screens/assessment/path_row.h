// SPDX-License-Identifier: GPL-3.0-or-later
// A place of a file or folder in a form: typed, dropped, or chosen by a dialog that whoever listens opens.
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
  // Three cells of `grid`: label, field, button. `title` has the label's key.
  PathRow(const QString& object_name, const QString& title, const QString& tip, QGridLayout& grid,
          QWidget* parent);

  QString path() const;
  void setPath(const QString& path);      // as a person does
  void proposePath(const QString& path);  // unless a person has set one
  void setMenu(QMenu* menu);              // of the button, in place of choosing at once
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
