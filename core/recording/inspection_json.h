// Stable JSON of `evical inspect --json`.
#pragma once

#include "core/recording/inspection.h"

#include <string>

namespace evical {

// `with_checksums` adds checksums for the comparison of readers.
std::string inspectionJson(const Inspection& inspection, bool with_checksums);

}  // namespace evical
