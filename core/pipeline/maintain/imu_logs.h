// Logs of IMUs that an old result knows, read as one: IMUs alternately in order of time, samples in SI units. Several
// logs are of several IMUs, or follow each other. Memory stays that of a packet a log.
#pragma once

#include "core/data/imu_sample.h"
#include "core/data/imu_units.h"
#include "core/recording/recording_reader.h"
#include "core/recording/separate_imu.h"
#include "core/recording/stray_stamps.h"
#include "core/report/result_yaml.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace evical {

struct ImuLogSettings {
  std::map<std::string, std::string> streams;  // by the IMU's name: a stream's name, or a log of it
  std::optional<AccelerationUnit> acceleration_unit;
  std::optional<AngularRateUnit> angular_rate_unit;
};

// How the calibration read an IMU's samples.
struct ImuReading {
  std::optional<AccelerationUnit> acceleration_unit = {};
  std::optional<AngularRateUnit> angular_rate_unit = {};
  AxesReading gyroscope_axes = kAxesAsTheyAre, accelerometer_axes = kAxesAsTheyAre;
  std::string columns = {};  // of a text table
  // Set if the recording has separate streams for the two sensors; otherwise the second is empty.
  std::string gyroscope_stream = {}, accelerometer_stream = {};
};
using ImuReadings = std::map<std::string, ImuReading>;  // by the IMU's name

struct ImuLogPacket {
  std::size_t imu = 0;  // of the old result
  std::vector<ImuSample> samples;
};

class ImuLogs {
 public:
  // Throws CalibrationError (BadInput) for logs that cannot be read, that hold no IMU of the result, or whose clocks
  // have nothing to do with each other.
  ImuLogs(const std::vector<std::filesystem::path>& logs, const NamedResult& before,
          const ImuLogSettings& settings, const ImuReadings& readings = {}, std::stop_token stop = {});

  const std::vector<std::size_t>& imus() const { return imus_; }  // of the result, ascending, that are there
  const StreamInfo& stream(std::size_t imu) const;                // of one of these
  std::int64_t start_ns() const { return start_ns_; }
  const std::vector<std::string>& notes() const { return notes_; }

  bool read(ImuLogPacket& packet);
  double fractionRead() const;
  std::vector<RecordingFault> faults() const;  // complete once read() has returned false

 private:
  struct Source {
    std::filesystem::path path;
    std::unique_ptr<RecordingReader> reader;
    std::vector<std::size_t> selected, imus;  // streams, and which IMUs these are
    std::vector<StampFilter<ImuSample>> filters;
    std::size_t flushed = 0;
    bool read_out = false, finished = false;
    Packet raw;
    ImuLogPacket next;
    std::int64_t time_ns() const;
  };

  std::unique_ptr<RecordingReader> openLog(const std::filesystem::path& log) const;
  std::optional<std::size_t> imuOf(const Source& source, const StreamInfo& stream, bool only_one) const;
  std::vector<SeparateImu> separateImus() const;
  bool isPartOfJoined(const Source& source, const std::string& stream) const;
  std::size_t imuStreams(const Source& source) const;
  void match(bool only_one);
  void advance(Source& source);
  void toSamples(const StreamInfo& info, const std::vector<RawImuSample>& raw, ImuLogPacket& packet) const;
  void checkClocks() const;
  void checkOrder(const Source& source);
  [[noreturn]] void refuseUnknown() const;

  const NamedResult& before_;
  ImuLogSettings settings_;
  ImuReadings readings_;
  std::stop_token stop_;
  std::vector<Source> sources_;
  std::vector<std::size_t> imus_;
  struct Latest {
    std::int64_t time_ns = 0;
    const Source* source = nullptr;
  };
  std::map<std::size_t, Latest> latest_;  // by IMU
  std::int64_t start_ns_ = 0;
  std::uint64_t immeasurable_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace evical
