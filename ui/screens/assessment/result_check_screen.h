// SPDX-License-Identifier: GPL-3.0-or-later
// Check of an old calibration with a new recording: shows what has changed, and the smallest changes that
// this recording would have shown.
#pragma once

#include "core/data/assessment.h"
#include "ui/screens/assessment/assessment_screen.h"

namespace evical::ui {

class FindingTable;
class OldResultRow;
class PathRow;

class ResultCheckScreen : public AssessmentScreen {
  Q_OBJECT

 public:
  explicit ResultCheckScreen(QWidget* parent = nullptr);

  OldResultRow& result() { return *result_; }
  PathRow& recording() { return *recording_; }
  void setCheck(const CalibrationCheck& check);

 private:
  void offer();

  OldResultRow* result_;
  PathRow* recording_;
  FindingTable* table_;
};

}  // namespace evical::ui
