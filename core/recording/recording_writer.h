// Writes recordings that other programs read too: for the simulator, and to convert between formats.
#pragma once

#include "core/data/event.h"
#include "core/data/imu_sample.h"
#include "core/geometry/camera_model.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

namespace evical {

// Add all streams first; then write each stream in time order (streams may alternate in any order, but those
// that write in time order across streams make recordings that read better); then finish. Without finish()
// nothing remains. All throw CalibrationError: BadInput for what a format can't hold, CalibrationFailed where
// the disk fails.
class RecordingWriter {
 public:
  virtual ~RecordingWriter() = default;
  virtual std::size_t addEventStream(const std::string& name, Resolution resolution_px) = 0;
  virtual std::size_t addImuStream(const std::string& name) = 0;
  virtual void write(std::size_t stream, EventSpan events) = 0;
  virtual void write(std::size_t stream, const ImuSample& sample) = 0;
  virtual void finish() = 0;
};

enum class BagCompression { None, Lz4 };

// A ROS 1 bag; any number of cameras and IMUs, streams are topics.
std::unique_ptr<RecordingWriter> createRosbag(const std::filesystem::path& path,
                                              BagCompression compression = BagCompression::None);

// A directory, made if need be, with events.txt and imu.txt: one camera, one IMU at most, their names are
// lost.
std::unique_ptr<RecordingWriter> createTextRecording(const std::filesystem::path& directory);

}  // namespace evical
