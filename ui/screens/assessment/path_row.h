// SPDX-License-Identifier: GPL-3.0-or-later
// Row for a file or folder in a form: typed, dropped, or chosen in a dialog that the receiver opens. The
// field shows the title of a path that has one; its tool tip has the path.
#pragma once

#include <QString>
#include <QWidget>

#include <map>
#include <utility>
#include <vector>

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
  void setPath(const QString& path);                         // like an edit of the user
  void proposePath(const QString& path);                     // unless the user has set one
  void setTitles(const std::map<QString, QString>& titles);  // by path
  void setMenu(QMenu* menu);                                 // of the button, instead of the dialog
  void setPlaceholder(const QString& text);
  void setEnabled(bool enabled);

 signals:
  void chooseRequested();
  void changed();

 private:
  QString shownAs(const QString& path) const;
  void show(const QString& path);

  QLineEdit* field_;
  QPushButton* choose_;
  QString tip_, path_;  // path_: the last one that was set; the user may have typed another
  std::map<QString, QString> titles_;
  bool by_hand_ = false;
};

// Row for an old result in a form: a folder, a file, or one of the session's runs.
class OldResultRow : public PathRow {
  Q_OBJECT

 public:
  OldResultRow(const QString& object_name, QGridLayout& grid, QWidget* parent);

  // By title and folder; listed after the entries for files, and shown by their titles.
  void setKeptRuns(const std::vector<std::pair<QString, QString>>& runs);

 signals:
  void folderRequested();
  void fileRequested();

 private:
  QMenu* menu_;
};

}  // namespace evical::ui
