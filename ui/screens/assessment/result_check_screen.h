// SPDX-License-Identifier: GPL-3.0-or-later
// Is an old calibration still good? An old result and a new recording go in; what has changed comes out, and what this
// recording would have shown.
#pragma once

#include "core/data/calibration_check.h"
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
