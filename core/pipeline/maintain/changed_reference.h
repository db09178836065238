// What all IMUs do against one of them at the same moment, that one has done.
#pragma once

#include "core/data/maintenance.h"

namespace evical {

// Steps of one quantity that all pairs have at one moment become one of the IMU that all are held against. Its numbers are
// left out: in each pair they are in other axes. Of a single pair nothing tells which one it was.
void nameChangedReference(Maintenance& maintenance);

}  // namespace evical
