// SPDX-License-Identifier: GPL-3.0-or-later
// Several recordings of one rig: each calibrated alone, then all together. Shows how well they agree, which
// ones do not fit, and a comparison of any two.
#pragma once

#include "core/data/assessment.h"
#include "ui/screens/assessment/assessment_screen.h"

#include <optional>

class QComboBox;
class QLabel;

namespace evical::ui {

class FileList;
class PathRow;
class RepeatedList;
class RepeatTable;

class RepeatScreen : public AssessmentScreen {
  Q_OBJECT

 public:
  explicit RepeatScreen(QWidget* parent = nullptr);

  PathRow& folder() { return *folder_; }
  FileList& files() { return *files_; }
  void setOpenFile(const QString& file);  // open in the window; empty: none
  void setRepeat(const Repeatability& repeat);

 signals:
  void openFolderRequested();
  void reportRequested();
  void openResultRequested(int recording);  // -1: joint solution

 private:
  void addForm();
  QWidget* makeNumbers();
  QWidget* makeRecordings();
  void offer();
  void offerPairs();
  void comparePair();

  FileList* files_;
  QPushButton* add_open_;
  PathRow* folder_;
  QLabel* ratio_;
  QComboBox *first_, *second_;
  RepeatTable* numbers_;
  RepeatedList* recordings_;
  QPushButton* open_result_;
  QString open_file_;
  std::optional<Repeatability> repeat_;
};

}  // namespace evical::ui
