// The stable JSON of `evical inspect --json`.
#pragma once

#include "core/recording/inspection.h"

#include <string>

namespace evical {

// `with_checksums` adds sums by which readers are compared.
std::string inspectionJson(const Inspection& inspection, bool with_checksums);

}  // namespace evical
