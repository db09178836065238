// Joins a gyroscope and an accelerometer with separate samples to one IMU. RealSense, OAK and ZED publish
// them on two topics, or alternate on one. Each sensor keeps its own samples and times.
#pragma once

#include "core/recording/recording_reader.h"

#include <memory>
#include <string>
#include <vector>

namespace evical {

// Names of the streams of the two sensors; equal if they alternate on one stream.
struct SeparateImu {
  std::string gyroscope, accelerometer;
};

// The joined stream's name.
std::string nameOf(const SeparateImu& imu);

// The recording's streams, followed by the joined ones. Throws CalibrationError (BadInput) if a stream is
// missing or is not of an IMU.
std::unique_ptr<RecordingReader> withSeparateImus(std::unique_ptr<RecordingReader> reader,
                                                  const std::vector<SeparateImu>& imus);

}  // namespace evical
