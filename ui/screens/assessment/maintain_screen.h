// SPDX-License-Identifier: GPL-3.0-or-later
// Maintenance of IMUs: compares logs with an old result and shows what has changed, and when.
#pragma once

#include "core/data/assessment.h"
#include "core/pipeline/maintain/imu_logs.h"
#include "ui/screens/assessment/assessment_screen.h"

class QComboBox;
class QLayout;
class QLineEdit;

namespace evical::ui {

class FileList;
class FindingTable;
class OldResultRow;
class PathRow;
class StepTable;

class MaintainScreen : public AssessmentScreen {
  Q_OBJECT

 public:
  // `charts`: widget with the numbers over time.
  explicit MaintainScreen(QWidget* charts, QWidget* parent = nullptr);

  OldResultRow& result() { return *result_; }
  FileList& logs() { return *logs_; }
  PathRow& trajectory() { return *trajectory_; }

  // Throws CalibrationError (BadInput) if the streams are not pairs NAME=STREAM.
  ImuLogSettings settings() const;
  void setMaintenance(const Maintenance& maintenance);

 private:
  QLayout* makeUnits();
  QWidget* makeContent(QWidget* charts);
  void offer();

  FileList* logs_;
  OldResultRow* result_;
  PathRow* trajectory_;
  QComboBox *acceleration_unit_, *rate_unit_;
  QLineEdit* streams_;
  StepTable* steps_;
  FindingTable* table_;
};

}  // namespace evical::ui
