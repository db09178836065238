// One pass over a recording: its content, and its faults.
#pragma once

#include "core/recording/imu_statistics.h"
#include "core/recording/recording_reader.h"

#include "core/base/progress.h"
#include "core/base/time.h"
#include "core/data/recording.h"

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace evical {

// A larger step back in time is a clock reset.
inline constexpr std::int64_t kClockReset_ns = kSecond_ns;

struct StreamSummary {
  StreamInfo info;
  std::uint64_t count = 0;  // events, IMU samples, frames, points; messages of other streams
  std::int64_t first_ns = 0, last_ns = 0;
  std::uint64_t backward_steps = 0;
  std::int64_t largest_gap_ns = 0;
  double rate_hz = 0.0;  // events, frames: mean; IMU: of the median interval

  // Events.
  std::uint64_t on = 0, off = 0;
  std::uint64_t sum_x = 0, sum_y = 0, sum_t = 0;  // modulo 2^64; times in the file's own unit
  Resolution seen_px;                             // largest coordinates + 1
  double shortest_interval_s =
      0.0;           // between events of one pixel: its refractory period and more; 0: unknown
  std::string note;  // not a fault: hot pixels with few events

  double shortest_exposure_s = 0.0, longest_exposure_s = 0.0;  // of frames; 0: unknown

  // IMU numbers in the file's units.
  // Units of the numbers below: stated by the format or, if that is SI, guessed from the numbers; "unknown"
  // if they allow no guess.
  std::string acceleration_unit, angular_rate_unit;
  Eigen::Vector3d mean_acceleration = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_angular_rate = Eigen::Vector3d::Zero();
  double median_acceleration = 0.0;                   // of the norm
  std::uint64_t without_rate = 0, without_force = 0;  // samples without that sensor
};

// Sensors of an IMU stream. Alternating: both, but each sample has only one.
enum class ImuStreamKind { Whole, Gyroscope, Accelerometer, Alternating };
ImuStreamKind imuStreamKind(const StreamSummary& stream);
ImuStreamKind imuStreamKind(const std::vector<ImuSample>& samples);  // by the values that are always 0

struct Inspection {
  std::string format;
  std::vector<StreamSummary> streams;  // in the order of RecordingReader::streams()
  std::vector<RecordingFault> faults;
};

// Reads to the end, including frames, which are not decoded; requires a fresh reader. Memory for events is
// eight bytes per pixel; IMU samples are kept.
Inspection inspectRecording(RecordingReader& reader, const InspectionOptions& options = {},
                            const RunContext& context = {});

// Gaps, time running backwards, jitter, stuck or saturated axes, units, invalid numbers. Expects SI units.
std::vector<RecordingFault> checkImu(const std::string& name, const std::vector<ImuSample>& samples,
                                     const InspectionOptions& options = {});

// Stable JSON of `evical inspect --json`.

// `with_checksums` adds checksums for the comparison of readers.
std::string inspectionJson(const Inspection& inspection, bool with_checksums);

}  // namespace evical
