// Writes recordings that we and others can read. A file appears under its name only once it is whole: until
// finish() it is "<name>.part", and it is removed when something fails or finish() is never called.
#pragma once

#include "core/data/recording.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

namespace evical {

class RecordingWriter {
 public:
  virtual ~RecordingWriter() = default;

  // `stream` is an index into the streams given at creation; times should not decrease within a stream, and
  // streams should be written alternately, some 10 ms each. All throw CalibrationError (CalibrationFailed),
  // e.g. on a full disk.
  virtual void write(std::size_t stream, EventSpan events) = 0;
  virtual void write(std::size_t stream, std::span<const ImuSample> samples) = 0;
  virtual void finish() = 0;
};

// A ROS 1 bag with dvs_msgs/EventArray and sensor_msgs/Imu; a stream's name is its topic, an event stream
// needs its resolution. Times must be within [0, 2^32) s.
std::unique_ptr<RecordingWriter> createBag(const std::filesystem::path& path,
                                           const std::vector<StreamInfo>& streams, bool lz4);

// "events.txt" and "imu.txt" in an existing folder; at most one stream of each type.
std::unique_ptr<RecordingWriter> createText(const std::filesystem::path& folder,
                                            const std::vector<StreamInfo>& streams);

}  // namespace evical
