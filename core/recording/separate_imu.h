// A gyroscope and an accelerometer that a recording keeps apart, as one IMU: RealSense, OAK and ZED write each to a topic of its
// own, or alternate on one. Each keeps its own samples and times.
#pragma once

#include "core/recording/recording_reader.h"

#include <memory>
#include <string>
#include <vector>

namespace evical {

// Names of the two sensors' streams; the same one where messages alternate.
struct SeparateImu {
  std::string gyroscope, accelerometer;
};

// The joined stream's name.
std::string nameOf(const SeparateImu& imu);

// The recording with the joined streams behind its own ones. Throws CalibrationError (BadInput) where a stream is missing, or is
// no IMU's.
std::unique_ptr<RecordingReader> withSeparateImus(std::unique_ptr<RecordingReader> reader,
                                                  const std::vector<SeparateImu>& imus);

}  // namespace evical
