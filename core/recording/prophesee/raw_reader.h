// Opens Prophesee's RAW (EVT 2.0, 2.1 in both orders of its halves, 3.0) and DAT files. Times are those of
// the file: no offset is subtracted, unlike Metavision's default.
#pragma once

#include "core/recording/recording_reader.h"

#include <filesystem>
#include <memory>

namespace evical {

// For files that begin with "% ", and DAT files without a header. Throws CalibrationError (BadInput).
std::unique_ptr<RecordingReader> openProphesee(const std::filesystem::path& path);

}  // namespace evical
