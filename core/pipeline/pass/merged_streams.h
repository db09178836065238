// Streams of several recordings read as one, each a sensor's: in packets, with known clock offsets added and IMU samples in
// SI units. What no sensor can have measured, and time stamps that no others bear out, stay outside. Of several files the
// one that is furthest behind is read next, so memory stays that of a packet a file.
#pragma once

#include "core/pipeline/session/session.h"
#include "core/recording/recording_reader.h"
#include "core/recording/stray_stamps.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace evical {

// Some events, frames or points of a camera or samples of an IMU.
struct SensorPacket {
  std::size_t sensor = 0;
  std::vector<Event> events;
  std::vector<ImuSample> imu_samples;
  std::vector<Frame> frames;
  std::vector<MeasuredPoint> points;

  bool empty() const { return events.empty() && imu_samples.empty() && frames.empty() && points.empty(); }
};

class MergedStreams {
 public:
  struct Stream {
    std::size_t in_file = 0, sensor = 0;
    std::string name;  // the sensor's
    double clock_offset_s = 0.0, clock_scale = 1.0;
    std::optional<SessionImu> imu = {};  // how its samples are to be read; none of a camera

    // What does not come in.
    StampFilter<Event> events{kEventStamps};
    StampFilter<ImuSample> samples{kSampleStamps};
    StampFilter<Frame> frames{kSampleStamps};
    StampFilter<MeasuredPoint> points{kPointStamps};
    std::optional<std::int64_t> first_ns = {};  // of its own clock
    std::uint64_t immeasurable = 0;
    std::int64_t immeasurable_ns = 0;  // the first
  };
  struct File {
    std::filesystem::path path;
    std::unique_ptr<RecordingReader> reader;
    std::vector<Stream> streams = {};
    Packet raw = {};  // as the reader hands it out
    SensorPacket next = {};
    bool read_out = false;    // then only what its streams still hold back is left
    std::size_t flushed = 0;  // of its streams
    bool finished = false;

    void add(std::size_t in_file, std::size_t sensor, const SessionCamera& camera);
    void add(std::size_t in_file, std::size_t sensor, const SessionImu& imu);
    const StreamInfo& info(const Stream& stream) const { return reader->streams()[stream.in_file]; }
    std::int64_t time_ns() const;
  };

  // Asked to stop, it ends as if the files did.
  explicit MergedStreams(std::stop_token stop) : stop_(std::move(stop)) {}

  std::vector<File>& files() { return files_; }
  const std::vector<File>& files() const { return files_; }

  // Reads the first packet of each file, whose streams are known by now. The time of the first item; none if there is none.
  std::optional<std::int64_t> begin();
  // Throws CalibrationError (BadInput), with this advice, for a file whose clock has nothing to do with that of the first,
  // which starts so much later. Files of the same sensors follow each other, however much later.
  void checkClocks(const std::function<std::string(double first_later_s)>& advice) const;

  // The file of the next packet; null at the end.
  const File* behind() const;
  bool read(SensorPacket& packet);
  double fractionRead() const;
  // Appends those of the readers.
  void addFaults(std::vector<RecordingFault>& faults) const;

 private:
  void advance(File& file);

  std::stop_token stop_;
  std::vector<File> files_;
};

}  // namespace evical
