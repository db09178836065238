// SPDX-License-Identifier: GPL-3.0-or-later
// What a check found of each quantity: its change as a whole, and below it the numbers before and now.
#pragma once

#include "core/data/calibration_check.h"
#include "ui/screens/assessment/copy_table.h"

#include <vector>

namespace evical::ui {

class CheckTable : public CopyTable {
  Q_OBJECT

 public:
  enum Column { kQuantity, kVerdict, kChange, kSigmas, kEdge, kNotice, kMatters, kBefore, kNow, kColumns };

  explicit CheckTable(QWidget* parent = nullptr);

  void setQuantities(std::vector<CheckedQuantity> quantities);

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void fill();

  std::vector<CheckedQuantity> quantities_;
};

}  // namespace evical::ui
