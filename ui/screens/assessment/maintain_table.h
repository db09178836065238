// SPDX-License-Identifier: GPL-3.0-or-later
// What logs say of IMUs: each quantity since the calibration, its numbers below it; and what changed on the way.
#pragma once

#include "core/data/maintenance.h"
#include "ui/screens/assessment/copy_table.h"

#include <vector>

namespace evical::ui {

class MaintainTable : public CopyTable {
  Q_OBJECT

 public:
  enum Column { kQuantity, kVerdict, kSource, kChange, kNotice, kBefore, kNow, kColumns };

  explicit MaintainTable(QWidget* parent = nullptr);

  void setQuantities(std::vector<MaintainedQuantity> quantities);

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void fill();

  std::vector<MaintainedQuantity> quantities_;
};

class StepTable : public CopyTable {
  Q_OBJECT

 public:
  enum Column { kWhat, kAt, kNoticed, kBy, kOrElse, kColumns };

  explicit StepTable(QWidget* parent = nullptr);

  void setSteps(const std::vector<MaintenanceStep>& steps);
};

}  // namespace evical::ui
