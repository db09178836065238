// SPDX-License-Identifier: GPL-3.0-or-later
// Several recordings of one rig: each calibrated alone, then all together; how well they agree, which do not fit, and any
// two beside each other.
#pragma once

#include "core/data/repeatability.h"

#include <QWidget>

#include <optional>

class QComboBox;
class QLabel;
class QListWidget;
class QPushButton;
class QStackedWidget;

namespace evical::ui {

class FileList;
class PathRow;
class RepeatedList;
class RepeatTable;
class VerdictLine;
class WorkBar;

class RepeatScreen : public QWidget {
  Q_OBJECT

 public:
  explicit RepeatScreen(QWidget* parent = nullptr);

  PathRow& folder() { return *folder_; }
  WorkBar& work() { return *work_; }

  FileList& files() { return *files_; }
  void setOpenFile(const QString& file);  // what is open in the window; empty: nothing
  void setRepeat(std::optional<Repeatability> repeat);

 signals:
  void repeatRequested();
  void cancelRequested();
  void openFolderRequested();
  void reportRequested();
  void openResultRequested(int recording);  // -1: of all together

 private:
  QWidget* makeForm();
  QWidget* makeEmpty();
  QWidget* makeContent();
  QWidget* makeNumbers();
  QWidget* makeRecordings();
  void offer();
  void showVerdict();
  void offerPairs();
  void comparePair();

  FileList* files_;
  QPushButton* add_open_;
  PathRow* folder_ = nullptr;
  WorkBar* work_ = nullptr;
  QStackedWidget* stack_;
  VerdictLine* verdict_;
  QLabel* ratio_;
  QComboBox *first_, *second_;
  RepeatTable* numbers_;
  RepeatedList* recordings_;
  QListWidget* notes_;
  QPushButton* open_result_;
  QString open_file_;
  std::optional<Repeatability> repeat_;
};

}  // namespace evical::ui
