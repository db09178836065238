// SPDX-License-Identifier: GPL-3.0-or-later
// Change of each quantity since an old result, with its numbers below it, and the changes during the logs.
#pragma once

#include "core/data/assessment.h"
#include "ui/screens/assessment/copy_table.h"

#include <vector>

namespace evical::ui {

class FindingTable : public CopyTable {
  Q_OBJECT

 public:
  enum Column {
    kQuantity,
    kVerdict,
    kSource,
    kChange,
    kBefore,
    kNow,  // the columns up to here are visible at 1280 px
    kTest,
    kEdge,
    kDetectable,
    kColumns
  };

  explicit FindingTable(QWidget* parent = nullptr);

  void setFindings(std::vector<Finding> findings);

 protected:
  void changeEvent(QEvent* event) override;
  bool copies(int column) const override;

 private:
  void fill();
  void showNumberColumns();

  std::vector<Finding> findings_;
};

class StepTable : public CopyTable {
  Q_OBJECT

 public:
  enum Column { kWhat, kAt, kNoticed, kBy, kAlternatives, kColumns };

  explicit StepTable(QWidget* parent = nullptr);

  void setSteps(const std::vector<MaintenanceStep>& steps);
};

// "0.5 ± 0.1 deg"
QString changeText(const Finding& finding);

}  // namespace evical::ui
