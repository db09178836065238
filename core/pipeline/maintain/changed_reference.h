// If all IMUs change relative to one of them at the same time, that one has changed.
#pragma once

#include "core/data/assessment.h"

namespace evical {

// Steps of one quantity that all pairs have at the same time become one step of the reference IMU. Its
// numbers are omitted, since each pair has them in other axes. For a single pair it is ambiguous which IMU
// has changed.
void nameChangedReference(Maintenance& maintenance);

}  // namespace evical
