// The sensors of iniVation and its forerunners, by the names that AEDAT files before version 4 give them.
#pragma once

#include "core/geometry/resolution.h"

#include <string_view>

namespace evical::aedat {

// Of "DAVIS240C", "Davis346blue", "DVS128"; unknown for others, and for what is no event camera.
Resolution chipSize(std::string_view name);

}  // namespace evical::aedat
