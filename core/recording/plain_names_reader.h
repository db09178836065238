// A recording with streams whose names have control characters (core/base/plain_text.h). No program writes
// such names; they would operate terminals, and end lines in files. These streams are listed with visible
// names, and not read.
#pragma once

#include "core/recording/recording_reader.h"

#include <memory>
#include <vector>

namespace evical {

// The reader itself if all names are plain.
std::unique_ptr<RecordingReader> withPlainNames(std::unique_ptr<RecordingReader> reader);

}  // namespace evical
