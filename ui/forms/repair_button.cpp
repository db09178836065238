// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/forms/repair_button.h"

#include "ui/forms/form_words.h"
#include "ui/theme/theme.h"

namespace evical::ui {

RepairButton::RepairButton(QWidget* parent) : QPushButton(evical::ui::icon("calibrate"), {}, parent) {
  setObjectName("repair");
  setAccessibleName(tr("Apply the proposed setting, and calibrate again"));
  setRepair({});
  connect(this, &QPushButton::clicked, this, [this] {
    if (repair_) emit repairRequested(Repair(*repair_));
  });
}

void RepairButton::setRepair(const std::optional<Repair>& repair) {
  repair_ = repair;
  setVisible(repair.has_value());
  if (!repair) return;
  const QString key = QString::fromStdString(repair->key), value = QString::fromStdString(repair->value);
  setText(inFormWords(tr("Set %1 to %2 and calibrate again").arg(key.section('.', -1), value)));
  setToolTip(tr("Sets %1: %2 in the session; Ctrl+Z undoes it").arg(key, value));
}

}  // namespace evical::ui
