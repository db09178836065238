// Event Stream files, version 2.0, of DVS and ATIS sensors (github.com/neuromorphicsystems/event_stream).
// Their y counts upwards, Evical's downwards; events that measure grey levels (ATIS) are skipped.
#pragma once

#include "core/recording/block_decoder.h"
#include "core/recording/recording_reader.h"

#include <filesystem>
#include <memory>
#include <string_view>

namespace evical {

inline constexpr std::string_view kEventStreamMagic = "Event Stream";

// Throws CalibrationError (BadInput), also for versions and kinds that cannot be read.
std::unique_ptr<RecordingReader> openEventStream(const std::filesystem::path& path);

}  // namespace evical
