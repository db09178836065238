// Reads recordings of any supported format as one pass of packets; memory does not grow with a recording's
// length. Times are ns in the file's own epoch; events have (0, 0) top left; IMU samples are in the
// IMU's own frame, in the units that their StreamInfo states.
#pragma once

#include "core/data/recording.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace evical {

class Growth;

class RecordingReader {
 public:
  virtual ~RecordingReader() = default;

  // All streams of the file, including those that cannot be decoded; known after opening.
  virtual const std::vector<StreamInfo>& streams() const = 0;

  // Selects the streams of read(), by index; all of type Events, Imu and Points if never called. Frames stay
  // encoded: unused ones are never decoded. Call before the first read.
  virtual void select(const std::vector<std::size_t>& streams) = 0;

  // The next packet, never an empty one, its events in order of time; false at the end. Reuses the
  // packet's storage. Packets are in the file's order: between packets, and between streams, time
  // may run backwards a little.
  virtual bool read(Packet& packet) = 0;

  // For a file that is still being written: from now on read() waits at its end until there is more or the
  // file has ended. False if this format must be complete.
  virtual bool follow(const std::shared_ptr<Growth>& /*growth*/) { return false; }

  virtual double fractionRead() const = 0;  // of the file's bytes, 0..1

  // Damage and anomalies so far: complete once read() has returned false.
  virtual const std::vector<RecordingFault>& faults() const = 0;

  virtual std::string format() const = 0;  // "rosbag", "text"
};

// Header lines that replace those of text tables, by the stream's name: "t_ns,-,ax,ay,az,gx,gy,gz".
using ColumnNames = std::map<std::string, std::string>;

// Opens a file or folder by its content.
//
//   const auto reader = openRecording("recording.bag");
//   for (Packet packet; reader->read(packet);)
//     for (const Event& event : packet.events) use(event);
//
// Throws CalibrationError (BadInput) if `path` cannot be
// read, or if `names` do not belong to text tables.
[[nodiscard]] std::unique_ptr<RecordingReader> openRecording(const std::filesystem::path& path,
                                                             const ColumnNames& names = {});

// Index of the stream of this name and one of these types; of several the first type's. Throws
// CalibrationError (BadInput) that lists the existing ones.
[[nodiscard]] std::size_t findStream(const RecordingReader& reader, const std::string& name,
                                     std::span<const StreamType> types);
[[nodiscard]] inline std::size_t findStream(const RecordingReader& reader, const std::string& name,
                                            StreamType type) {
  return findStream(reader, name, std::span(&type, 1));
}

const char* streamTypeName(StreamType type);  // "events", "imu", "frames", "points", "triggers" or "other"

}  // namespace evical
