// SPDX-License-Identifier: GPL-3.0-or-later
// Is an old calibration still good? An old result and a new recording go in; what has changed comes out, and what this
// recording would have shown.
#pragma once

#include "core/data/calibration_check.h"

#include <QWidget>

#include <optional>
#include <utility>
#include <vector>

class QLabel;
class QListWidget;
class QMenu;
class QPushButton;
class QStackedWidget;

namespace evical::ui {

class CheckTable;
class PathRow;
class WorkBar;

class ResultCheckScreen : public QWidget {
  Q_OBJECT

 public:
  explicit ResultCheckScreen(QWidget* parent = nullptr);

  PathRow& result() { return *result_; }
  PathRow& recording() { return *recording_; }
  WorkBar& work() { return *work_; }
  // By title and folder; beside the files that can be chosen.
  void setKeptRuns(const std::vector<std::pair<QString, QString>>& runs);
  void setCheck(std::optional<CalibrationCheck> check);

 signals:
  void resultFolderRequested();
  void resultFileRequested();
  void checkRequested();
  void cancelRequested();
  void saveRequested();

 protected:
  void changeEvent(QEvent* event) override;

 private:
  QWidget* makeForm();
  QWidget* makeEmpty();
  QWidget* makeContent();
  void offer();
  void showVerdict();
  void showNotes();

  PathRow *result_ = nullptr, *recording_ = nullptr;
  WorkBar* work_ = nullptr;
  QMenu* results_;
  QStackedWidget* stack_;
  QLabel *icon_, *verdict_, *reason_;
  CheckTable* table_;
  QListWidget* notes_;
  QPushButton* save_;
  std::optional<CalibrationCheck> check_;
};

}  // namespace evical::ui
