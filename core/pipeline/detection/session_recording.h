// Recordings of a session read as one: the streams of its sensors.
#pragma once

#include "core/pipeline/detection/merged_streams.h"

#include "core/pipeline/session/session.h"
#include "core/recording/separate_imu.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace evical {

// States that images are reversed, for the notes of a result; empty if they are not.
std::string reversalNote(const SessionCamera& camera);

// Tables of a gyroscope and an accelerometer as one recording. `names`: header lines by table.
std::unique_ptr<RecordingReader> openBoth(const std::filesystem::path& gyroscope,
                                          const std::filesystem::path& accelerometer,
                                          const ColumnNames& names = {});

// Sensor numbers of packets: cameras from 0, then IMUs.
class SessionRecording {
 public:
  // Opens the files and reads the first packet of each. Throws CalibrationError (BadInput) for missing files
  // and streams, and for files with unrelated clocks. When asked to stop, it behaves as at the end of the
  // files.
  // `growth`: of the only file, if it is still being written.
  explicit SessionRecording(const Session& session, std::stop_token stop = {},
                            const std::shared_ptr<Growth>& growth = nullptr);

  std::size_t imuSensor(std::size_t imu) const { return session_.cameras.size() + imu; }

  const StreamInfo& camera(std::size_t camera) const { return info(camera); }
  CameraKind kind(std::size_t camera) const;
  // The session's, the recording's, or the intrinsics': the first one that is known. Throws if none is,
  // except for frames, which have it themselves.
  Resolution resolution_px(std::size_t camera) const;

  // Time of the first event or sample in any file; 0 if there is none.
  std::int64_t start_ns() const { return start_ns_; }

  // At the end, throws CalibrationError (BadInput) if the times of a sensor cannot be true.
  bool read(SensorPacket& packet);
  double fractionRead() const { return streams_.fractionRead(); }
  // Faults of the files, and removed data; complete after read() has returned false.
  std::vector<RecordingFault> faults() const;

 private:
  // Files that one reader opens: two, if gyroscope and accelerometer have their own. Sensors that name the
  // columns of one table differently have their own readers.
  struct Source {
    std::filesystem::path file, accelerometer_file;
    std::string columns;
    bool operator==(const Source&) const = default;
  };
  template <class Sensor>
  Source sourceOf(const Sensor& sensor) const;
  template <class Sensor>
  std::size_t fileOf(const Sensor& sensor);
  ColumnNames columnNames(const Source& source) const;
  std::vector<SeparateImu> separateImus(const Source& source) const;
  template <class Sensor>
  void addSensor(const char* section, const Sensor& sensor, const std::string& stream,
                 std::span<const StreamType> types);
  const MergedStreams::Stream& stream(std::size_t sensor) const;
  const StreamInfo& info(std::size_t sensor) const;
  void addFaults(std::size_t sensor, std::vector<RecordingFault>& faults) const;
  bool isCameraAlone() const;
  void checkTimed() const;
  void checkTimes() const;
  void unmirror(SensorPacket& packet) const;

  const Session& session_;
  MergedStreams streams_;
  std::vector<Source> sources_;  // of the files
  std::vector<std::pair<std::size_t, std::size_t>>
      places_;  // by sensor: indices of the file, and of the stream in the file
  std::int64_t start_ns_ = 0;
};

// Time range of a session, and the decision when the rest of a recording need not be read.
class SessionTimeRange {
 public:
  // `sensors`: number of sensors.
  SessionTimeRange(const Session& session, std::size_t sensors, std::int64_t start_ns)
      : session_(session), start_ns_(start_ns), latest_ns_(start_ns), behind_(sensors) {}

  // True for all times if the session has no time range.
  bool holds(std::int64_t time_ns) const;

  // True after all sensors are well beyond the range: a wrong timestamp is followed by correct ones. Must be
  // called with all packets in order.
  bool isOver(const SensorPacket& packet);

  // Throws CalibrationError (BadInput) if all data are before the range. Call it at the end.
  void checkBegin() const;

 private:
  const Session& session_;
  std::int64_t start_ns_, latest_ns_;  // latest_ns_: of all data
  std::vector<bool> behind_;
};

}  // namespace evical
