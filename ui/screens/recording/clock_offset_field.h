// SPDX-License-Identifier: GPL-3.0-or-later
// Seconds that are added to the stamps of a sensor recorded into a separate file.
#pragma once

#include "ui/forms/number_field.h"

namespace evical::ui {

inline NumberField* clockOffsetField(QWidget* parent) {
  constexpr double kMax_s = 1e10;  // between any clocks that count from 1970 or from power-on
  auto* const field = new NumberField(-kMax_s, kMax_s, parent);
  field->setToolTip(
      QObject::tr("Seconds to add to the times of this sensor's file if its clock has another zero than the "
                  "recording. The remaining error must be within the searched time offset "
                  "(initialisation)"));
  return field;
}

}  // namespace evical::ui
