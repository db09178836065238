// Copies a recording's events, IMU samples and, if the format supports them, frames into another format.
#pragma once

#include "core/base/progress.h"
#include "core/recording/recording_reader.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace evical {

struct RecordingFormat;

// True if a recording of this format can have the stream.
bool isWritable(const StreamInfo& stream, const RecordingFormat& format);

struct ConversionRequest {
  std::filesystem::path input, output;
  std::string format;                // of recordingFormats(); empty: by the output's extension
  std::vector<std::string> streams;  // names; all that the format supports if empty
  Resolution resolution_px;          // of event streams, if the file does not state it
};

struct ConversionSummary {
  std::string format;
  std::vector<StreamInfo> streams;  // written; in SI units
  std::uint64_t events = 0, imu_samples = 0, frames = 0;
  std::vector<RecordingFault> faults;  // of the input
};

// The output appears when it is complete; a folder is created if necessary. IMU samples are in the units of
// the target. If neither the file nor the request gives a sensor's size, another pass over the events
// determines it. Throws CalibrationError, and Cancelled.
ConversionSummary convertRecording(const ConversionRequest& request, const RunContext& context);

}  // namespace evical
