// SPDX-License-Identifier: GPL-3.0-or-later
// What is to be added to the times of a sensor that was recorded into a file of its own.
#pragma once

#include "ui/forms/number_field.h"

namespace evical::ui {

inline NumberField* clockOffsetField(QWidget* parent) {
  constexpr double kMost_s = 1e10;  // the difference of any two clocks that count from 1970 or from power-on
  auto* const field = new NumberField(-kMost_s, kMost_s, parent);
  field->setToolTip(
      QObject::tr("Where this sensor's own file counts time from another zero: the seconds to add to its "
                  "times so that they are those of the recording, within the searched time offset "
                  "(initialisation)"));
  return field;
}

}  // namespace evical::ui
