// Streams of several recordings read as one, each of one sensor: in packets, with known clock offsets added
// and IMU samples in SI units. Implausible values and isolated wrong timestamps are removed. The file that is
// furthest behind in time is read next, so that only one packet per file is in memory.
#pragma once

#include "core/pipeline/session/session.h"
#include "core/recording/recording_reader.h"
#include "core/recording/stray_stamps.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace evical {

// Events, frames or points of a camera, or samples of an IMU.
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
    std::string name;  // of the sensor
    double clock_offset_s = 0.0, clock_scale = 1.0;
    std::optional<SessionImu> imu = {};  // interpretation of its samples; absent for a camera

    // Filters and counts of removed data; their times are in the sensor's own clock.
    StampFilter<Event> events{kEventStamps};
    StampFilter<ImuSample> samples{kSampleStamps};
    StampFilter<Frame> frames{kSampleStamps};
    StampFilter<MeasuredPoint> points{kPointStamps};
    std::optional<std::int64_t> first_ns = {};  // in its own clock; fixed point of clock_scale
    // Number of frames or views so far, in place of times that cannot be true, and the last recorded time.
    std::optional<std::int64_t> numbered = {};
    std::int64_t recorded_ns = 0;
    std::uint64_t immeasurable = 0;
    std::int64_t immeasurable_ns = 0;  // the first

    // By clock_scale and clock_offset_s; nullopt for a time that no recording has.
    std::optional<std::int64_t> sessionTime_ns(std::int64_t own_ns) const;
  };
  struct File {
    std::filesystem::path path;
    std::unique_ptr<RecordingReader> reader;
    std::vector<Stream> streams = {};
    std::deque<Packet> ahead = {};  // read to judge the times of frames
    Packet raw = {};                // from the reader
    SensorPacket next = {};
    bool read_out = false;    // true: only samples inside the filters remain
    std::size_t flushed = 0;  // number of flushed streams
    bool finished = false;

    void add(std::size_t in_file, std::size_t sensor, const SessionCamera& camera);
    void add(std::size_t in_file, std::size_t sensor, const SessionImu& imu);
    const StreamInfo& info(const Stream& stream) const { return reader->streams()[stream.in_file]; }
    Stream& of(const Packet& packet);
    std::int64_t time_ns() const;
  };

  // When asked to stop, it behaves as at the end of the files.
  explicit MergedStreams(std::stop_token stop) : stop_(std::move(stop)) {}

  std::vector<File>& files() { return files_; }
  const std::vector<File>& files() const { return files_; }

  // Reads the first packet of each file; all streams must be known. Returns the time of the first item, if
  // any. For a camera alone, frames and points whose times cannot be true are numbered 1 s apart.
  std::optional<std::int64_t> begin(bool camera_alone = false);
  // Throws CalibrationError (BadInput), with this advice, for a file whose clock is unrelated to that of the
  // first file, which starts later by the argument. Files of the same sensors may follow each other after any
  // time.
  void checkClocks(const std::function<std::string(double first_later_s)>& advice) const;

  // The file of the next packet; null at the end.
  const File* behind() const;
  bool read(SensorPacket& packet);
  double fractionRead() const;
  bool isStopped() const { return stop_.stop_requested(); }
  // Appends the faults of the readers.
  void addFaults(std::vector<RecordingFault>& faults) const;

 private:
  void advance(File& file);
  bool readPacket(File& file) const;
  void judgeTimes(File& file) const;

  std::stop_token stop_;
  std::vector<File> files_;
};

}  // namespace evical
