// A recording for the stages: named streams that are read once, in packets.
#pragma once

#include "core/data/event.h"
#include "core/data/frame.h"
#include "core/data/imu_units.h"
#include "core/data/recording_fault.h"
#include "core/geometry/resolution.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace evical {

enum class StreamType { Events, Imu, Frames, Points, Triggers, Other };

struct StreamInfo {
  std::string name;  // topic, or the stream's name in the file
  StreamType type = StreamType::Other;
  std::string message;            // type of the content in the file, e.g. dvs_msgs/EventArray
  Resolution resolution_px;       // of events and frames, if the file specifies it
  std::uint64_t messages = 0;     // 0 if unknown
  std::int64_t time_unit_ns = 1;  // resolution of times in the file
  // Units of IMU samples in this format.
  AccelerationUnit acceleration_unit = AccelerationUnit::MetresPerSecond2;
  AngularRateUnit angular_rate_unit = AngularRateUnit::RadiansPerSecond;
  // If times are the sensor's own and the file also has the host's reception times: what to add to get the
  // host's clock, as used by IMU samples from other sources. More accurate after all has been read.
  std::optional<double> host_clock_offset_s = std::nullopt;
  bool readable = true;     // false: only listed; a fault gives the reason unless it is obvious
  bool timed = true;        // false: pictures without times, numbered 1 s apart, for intrinsics only
  std::string source = {};  // the recording device, if the file specifies it: "DAVIS346_00000002"
};

// Largest sensor side in pixels that is accepted in a file: coordinates have 16 bits.
inline constexpr int kLargestSide_px = 65536;

// Result of one call of RecordingReader::read, all from one stream: some events, some samples in the stream's
// units, a few frames, or the points of one time.
struct Packet {
  std::size_t stream = 0;  // index into RecordingReader::streams()
  std::vector<Event> events;
  std::vector<RawImuSample> imu_samples;
  std::vector<Frame> frames;
  std::vector<MeasuredPoint> points;

  bool empty() const { return events.empty() && imu_samples.empty() && frames.empty() && points.empty(); }
  void clear() {
    events.clear();
    imu_samples.clear();
    frames.clear();
    points.clear();
  }
};

}  // namespace evical
