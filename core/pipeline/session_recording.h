// The recordings of a session read as one: the streams of its sensors in packets, with known clock offsets
// added and IMU samples in SI units. Of several files the one that is furthest behind is read next, so memory
// stays that of a packet a file.
#pragma once

#include "core/pipeline/session.h"
#include "core/recording/recording_reader.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace evical {

// Some events of a camera or samples of an IMU; the first camera's is sensor 0, the first IMU's that behind
// the last camera's.
struct SensorPacket {
  std::size_t sensor = 0;
  std::vector<Event> events;
  std::vector<ImuSample> imu_samples;
};

class SessionRecording {
 public:
  // Opens the files and reads the first packet of each. Throws CalibrationError (BadInput) for files and
  // streams that are not there, and for files whose clocks have nothing to do with each other.
  explicit SessionRecording(const Session& session);

  std::size_t imuSensor(std::size_t imu) const { return session_.cameras.size() + imu; }

  const StreamInfo& camera(std::size_t camera) const { return info(camera); }
  // The session's, the recording's, or the intrinsics': whichever is known first. Throws where none is.
  Resolution resolution_px(std::size_t camera) const;

  // Time of the first event or sample in any file; 0 where there is none.
  std::int64_t start_ns() const { return start_ns_; }

  bool read(SensorPacket& packet);
  double fractionRead() const;
  std::vector<RecordingFault> faults() const;  // complete once read() has returned false

 private:
  // One file.
  struct Source {
    std::filesystem::path path;
    std::unique_ptr<RecordingReader> reader;
    std::vector<std::size_t> selected, sensors;  // streams of the file, and what they are here
    Packet raw;                                  // as the reader hands it out
    SensorPacket next;
    bool finished = false;
    std::int64_t time_ns() const;
  };
  struct Place {
    std::size_t source = 0, stream = 0;
  };

  std::size_t sourceOf(const std::filesystem::path& path);
  void addSensor(const std::filesystem::path& path, const std::string& stream, StreamType type);
  void advance(Source& source);
  void bringHome(Packet& raw, SensorPacket& packet) const;
  void checkClocks() const;
  const StreamInfo& info(std::size_t sensor) const;

  const Session& session_;
  std::vector<Source> sources_;
  std::vector<Place> places_;  // by sensor
  std::int64_t start_ns_ = 0;
};

}  // namespace evical
