// AEDAT 2.0, as jAER records it: events of a DVS128 or a DAVIS, and a DAVIS's IMU samples and frames.
// Source: iniVation's "AEDAT file formats", jAER (DavisChip, IMUSample, DVS128).
#pragma once

#include "core/recording/recording_reader.h"

#include <filesystem>
#include <memory>
#include <string_view>

namespace evical {

inline constexpr std::string_view kAedat2Magic = "#!AER-DAT2.0";

// Throws CalibrationError (BadInput) for other chips.
std::unique_ptr<RecordingReader> openAedat2(const std::filesystem::path& path);

}  // namespace evical
