// SPDX-License-Identifier: GPL-3.0-or-later
// Button for the setting that would repair a result or a failure: sets it in the session and calibrates
// again.
#pragma once

#include "core/base/error.h"

#include <QPushButton>

#include <optional>

namespace evical::ui {

class RepairButton : public QPushButton {
  Q_OBJECT

 public:
  explicit RepairButton(QWidget* parent = nullptr);

  void setRepair(const std::optional<Repair>& repair);  // hidden without one

 signals:
  void repairRequested(const evical::Repair& repair);

 private:
  std::optional<Repair> repair_;
};

}  // namespace evical::ui
