// The sensors of iniVation and its predecessors, by their names in AEDAT files before version 4.
#pragma once

#include "core/geometry/resolution.h"

#include <string_view>

namespace evical::aedat {

// Size of "DAVIS240C", "Davis346blue", "DVS128"; unknown for others, and for devices that are not event
// cameras.
Resolution chipSize(std::string_view name);

}  // namespace evical::aedat
