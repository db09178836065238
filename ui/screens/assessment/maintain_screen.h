// SPDX-License-Identifier: GPL-3.0-or-later
// Are IMUs still as they were calibrated? An old result and logs go in; what has changed, and when, comes out.
#pragma once

#include "core/data/maintenance.h"
#include "core/pipeline/maintain/imu_logs.h"

#include <QWidget>

#include <optional>

class QComboBox;
class QLineEdit;
class QListWidget;
class QPushButton;
class QStackedWidget;

namespace evical::ui {

class FileList;
class MaintainTable;
class OldResultRow;
class PathRow;
class StepTable;
class VerdictLine;
class WorkBar;

class MaintainScreen : public QWidget {
  Q_OBJECT

 public:
  // `charts`: what shows numbers over time.
  explicit MaintainScreen(QWidget* charts, QWidget* parent = nullptr);

  OldResultRow& result() { return *result_; }
  FileList& logs() { return *logs_; }
  PathRow& trajectory() { return *trajectory_; }
  WorkBar& work() { return *work_; }

  // Throws CalibrationError (BadInput) where streams are given in words that say nothing.
  ImuLogSettings settings() const;
  void setMaintenance(std::optional<Maintenance> maintenance);

 signals:
  void maintainRequested();
  void cancelRequested();
  void saveRequested();

 protected:
  void changeEvent(QEvent* event) override;

 private:
  QWidget* makeForm();
  QLayout* makeUnits();
  QWidget* makeEmpty();
  QWidget* makeContent(QWidget* charts);
  void offer();
  void showNotes();

  OldResultRow* result_ = nullptr;
  FileList* logs_;
  PathRow* trajectory_ = nullptr;
  QComboBox *acceleration_unit_, *rate_unit_;
  QLineEdit* streams_;
  WorkBar* work_ = nullptr;
  QStackedWidget* stack_;
  VerdictLine* verdict_;
  StepTable* steps_;
  MaintainTable* table_;
  QListWidget* notes_;
  QPushButton* save_;
  std::optional<Maintenance> maintenance_;
};

}  // namespace evical::ui
