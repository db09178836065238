// The recordings of a session read as one: the streams of its sensors in packets, with known clock offsets
// added and IMU samples in SI units. What no sensor can have measured, and time stamps that no others bear
// out, stay outside. Of several files the one that is furthest behind is read next, so memory
// stays that of a packet a file.
#pragma once

#include "core/pipeline/session/session.h"
#include "core/recording/recording_reader.h"
#include "core/recording/separate_imu.h"
#include "core/recording/stray_stamps.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

namespace evical {

// Some events, frames or points of a camera or samples of an IMU; the first camera's is sensor 0, the first IMU's
// that behind the last camera's.
struct SensorPacket {
  std::size_t sensor = 0;
  std::vector<Event> events;
  std::vector<ImuSample> imu_samples;
  std::vector<Frame> frames;
  std::vector<MeasuredPoint> points;

  bool empty() const { return events.empty() && imu_samples.empty() && frames.empty() && points.empty(); }
};

class SessionRecording {
 public:
  // Opens the files and reads the first packet of each. Throws CalibrationError (BadInput) for files and
  // streams that are not there, and for files whose clocks have nothing to do with each other.
  // Asked to stop, it ends as if the files did.
  explicit SessionRecording(const Session& session, std::stop_token stop = {});

  std::size_t imuSensor(std::size_t imu) const { return session_.cameras.size() + imu; }

  const StreamInfo& camera(std::size_t camera) const { return info(camera); }
  CameraKind kind(std::size_t camera) const;
  // The session's, the recording's, or the intrinsics': whichever is known first. Throws where none is, but of
  // frames, which tell it themselves.
  Resolution resolution_px(std::size_t camera) const;

  // Time of the first event or sample in any file; 0 where there is none.
  std::int64_t start_ns() const { return start_ns_; }

  bool read(SensorPacket& packet);
  double fractionRead() const;
  // Of the files, and what was kept outside; complete once read() has returned false.
  std::vector<RecordingFault> faults() const;

 private:
  // One file.
  struct Source {
    std::filesystem::path path;
    std::unique_ptr<RecordingReader> reader;
    std::vector<std::size_t> selected, sensors;  // streams of the file, and what they are here
    Packet raw;                                  // as the reader hands it out
    SensorPacket next;
    bool read_out = false;    // then only what its sensors still hold back is left
    std::size_t flushed = 0;  // of its sensors
    bool finished = false;
    std::int64_t time_ns() const;
  };
  struct Place {
    std::size_t source = 0, stream = 0;
  };
  // What does not come in from one sensor.
  struct Gate {
    StampFilter<Event> events{kEventStamps};
    StampFilter<ImuSample> samples{kSampleStamps};
    StampFilter<Frame> frames{kSampleStamps};
    StampFilter<MeasuredPoint> points{kPointStamps};
    std::optional<std::int64_t> first_ns = {};  // of its own clock
    std::uint64_t immeasurable = 0;
    std::int64_t immeasurable_ns = 0;  // the first
  };

  std::size_t sourceOf(const std::filesystem::path& path);
  template <class Sensor>
  bool isIn(const std::filesystem::path& path, const Sensor& sensor) const;
  ColumnNames columnNames(const std::filesystem::path& path) const;
  std::vector<SeparateImu> separateImus(const std::filesystem::path& path) const;
  void addSensor(const std::filesystem::path& path, const std::string& stream,
                 std::span<const StreamType> types);
  void advance(Source& source);
  void bringHome(Packet& raw, SensorPacket& packet);
  void setClock(SensorPacket& packet);
  void letIn(SensorPacket& packet);
  bool flushNext(Source& source);
  void addFaults(std::size_t sensor, std::vector<RecordingFault>& faults) const;
  void checkTimed() const;
  void checkClocks() const;
  const StreamInfo& info(std::size_t sensor) const;

  const Session& session_;
  std::stop_token stop_;
  std::vector<Source> sources_;
  std::vector<Place> places_;  // by sensor
  std::vector<Gate> gates_;    // by sensor
  std::int64_t start_ns_ = 0;
};

}  // namespace evical
