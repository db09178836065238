// SPDX-License-Identifier: GPL-3.0-or-later
// Is an old calibration still good? An old result and a new recording go in; what has changed comes out, and what this
// recording would have shown.
#pragma once

#include "core/data/calibration_check.h"

#include <QWidget>

#include <optional>

class QListWidget;
class QPushButton;
class QStackedWidget;

namespace evical::ui {

class CheckTable;
class OldResultRow;
class PathRow;
class VerdictLine;
class WorkBar;

class ResultCheckScreen : public QWidget {
  Q_OBJECT

 public:
  explicit ResultCheckScreen(QWidget* parent = nullptr);

  OldResultRow& result() { return *result_; }
  PathRow& recording() { return *recording_; }
  WorkBar& work() { return *work_; }
  void setCheck(std::optional<CalibrationCheck> check);

 signals:
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
  void showNotes();

  OldResultRow* result_ = nullptr;
  PathRow* recording_ = nullptr;
  WorkBar* work_ = nullptr;
  QStackedWidget* stack_;
  VerdictLine* verdict_;
  CheckTable* table_;
  QListWidget* notes_;
  QPushButton* save_;
  std::optional<CalibrationCheck> check_;
};

}  // namespace evical::ui
