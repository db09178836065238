// The recordings of a session read as one: the streams of its sensors.
#pragma once

#include "core/pipeline/pass/merged_streams.h"
#include "core/recording/separate_imu.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

namespace evical {

// The first camera's packets are of sensor 0, the first IMU's of that behind the last camera's.
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

  bool read(SensorPacket& packet) { return streams_.read(packet); }
  double fractionRead() const { return streams_.fractionRead(); }
  // Of the files, and what was kept outside; complete once read() has returned false.
  std::vector<RecordingFault> faults() const;

 private:
  std::size_t fileOf(const std::filesystem::path& path);
  template <class Sensor>
  bool isIn(const std::filesystem::path& path, const Sensor& sensor) const;
  ColumnNames columnNames(const std::filesystem::path& path) const;
  std::vector<SeparateImu> separateImus(const std::filesystem::path& path) const;
  template <class Sensor>
  void addSensor(const Sensor& sensor, const std::string& stream, std::span<const StreamType> types);
  const MergedStreams::Stream& stream(std::size_t sensor) const;
  const StreamInfo& info(std::size_t sensor) const;
  void addFaults(std::size_t sensor, std::vector<RecordingFault>& faults) const;
  void checkTimed() const;

  const Session& session_;
  MergedStreams streams_;
  std::vector<std::pair<std::size_t, std::size_t>>
      places_;  // by sensor: of the file, and of the stream among its own
  std::int64_t start_ns_ = 0;
};

}  // namespace evical
