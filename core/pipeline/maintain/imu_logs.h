// Logs of IMUs of an old result, read as one. Several logs are of different IMUs, or follow each other.
#pragma once

#include "core/data/imu_units.h"
#include "core/maintenance/stop_detection.h"
#include "core/pipeline/detection/merged_streams.h"
#include "core/recording/separate_imu.h"
#include "core/report/result_yaml.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace evical {

struct ImuLogSettings {
  std::map<std::string, std::string> streams;  // by the IMU's name: name of a stream or a log
  std::optional<AccelerationUnit> acceleration_unit;
  std::optional<AngularRateUnit> angular_rate_unit;
};

using ImuReadings =
    std::map<std::string, SessionImu>;  // by the IMU's name: reading of its samples in the calibration

class ImuLogs {
 public:
  // Throws CalibrationError (BadInput) for unreadable logs, logs without an IMU of the result, or unrelated
  // clocks.
  ImuLogs(const std::vector<std::filesystem::path>& logs, const NamedResult& before,
          const ImuLogSettings& settings, const ImuReadings& readings = {}, std::stop_token stop = {});

  const std::vector<std::size_t>& imus() const {
    return imus_;
  }                                                 // indices in the result of existing IMUs, ascending
  const StreamInfo& stream(std::size_t imu) const;  // of one of these
  std::int64_t start_ns() const { return start_ns_; }
  const std::vector<std::string>& notes() const { return notes_; }

  bool read(SensorPacket& packet);  // of an IMU of the result
  double fractionRead() const { return streams_.fractionRead(); }
  // Complete after read() has returned false: faults, and the step of an IMU's coarse stamps, 0 for others.
  std::vector<RecordingFault> faults() const;
  double stampStep_s(std::size_t imu) const;

 private:
  using Log = MergedStreams::File;

  // Samples wait until the stamps around them are known.
  struct Block {
    std::int64_t first_ns = 0;  // of the log
    std::vector<ImuSample> waiting = {}, ready = {};
    std::size_t taken = 0;      // of `ready`
    std::size_t next_size = 0;  // of `waiting`, at which it is sorted again
    double stamp_step_s = 0.0;
  };

  struct LogFiles {
    std::filesystem::path log, accelerometer;  // the latter is empty unless two tables have the sensors
  };
  std::vector<LogFiles> paired(const std::vector<std::filesystem::path>& logs) const;
  std::unique_ptr<RecordingReader> openLog(const LogFiles& files) const;
  std::unique_ptr<RecordingReader> openPair(const LogFiles& files) const;
  enum class MatchedBy { Setting, Stream, Name, Default };  // the most certain first
  struct Match {
    std::size_t imu = 0;
    MatchedBy by = MatchedBy::Default;
  };
  std::optional<Match> imuOf(const Log& log, const StreamInfo& stream, bool only_one) const;
  std::vector<std::optional<Match>> matchesOf(const Log& log, bool only_one) const;
  bool isCandidate(const Log& log, const StreamInfo& stream) const;  // may be an IMU of the result
  std::vector<SeparateImu> separateImus() const;
  bool isPartOfJoined(const Log& log, const std::string& stream) const;
  std::size_t imuStreams(const Log& log) const;
  void match(bool only_one);
  SessionImu readingOf(std::size_t imu) const;
  void checkOrder(const Log& log);
  void readBlock();
  void release(bool all);
  void putInOrder(std::size_t imu, Block& block, bool all);
  [[noreturn]] void refuseUnknown() const;

  const NamedResult& before_;
  ImuLogSettings settings_;
  ImuReadings readings_;
  MergedStreams streams_;
  std::vector<std::size_t> imus_;
  struct Latest {
    std::int64_t time_ns = 0;
    const Log* log = nullptr;
  };
  std::map<std::size_t, Latest> latest_;  // by IMU

  std::map<std::size_t, Block> blocks_;  // by IMU
  std::deque<SensorPacket> packets_;
  std::vector<RecordingFault> stamp_faults_;
  bool ended_ = false;
  std::int64_t start_ns_ = 0;
  std::vector<std::string> notes_;
};

// Checks of the units of IMU logs from their values. Each throws CalibrationError (BadInput) with the setting
// to change.
struct ImuMeans {
  std::string name;
  std::span<const MeansWindow> windows;
};

// Detects forces in g or milli-g, and rates in deg/s.
void checkUnits(const ImuMeans& imu);

// Detects opposite specific forces of two IMUs on one body. `later_s` is added to the own times.
void checkDirection(const ImuMeans& own, const ImuMeans& reference,
                    const Eigen::Quaterniond& reference_from_own, double later_s);

}  // namespace evical
