// A recording as the stages see it: named streams that go by once, in packets.
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
  std::string message;            // what the file calls its content, e.g. dvs_msgs/EventArray
  Resolution resolution_px;       // of events and frames, where the file says it
  std::uint64_t messages = 0;     // 0 if unknown
  std::int64_t time_unit_ns = 1;  // the file's own
  // What the format says the numbers of IMU samples are in.
  AccelerationUnit acceleration_unit = AccelerationUnit::MetresPerSecond2;
  AngularRateUnit angular_rate_unit = AngularRateUnit::RadiansPerSecond;
  // Where times are the sensor's own and the file also tells when the host received them: what to add to get
  // the host's, as IMU samples from elsewhere have them. Better once all has been read.
  std::optional<double> host_clock_offset_s = std::nullopt;
  bool readable = true;     // false: it is only listed; a fault says why where that is not obvious
  bool timed = true;        // false: pictures without times, numbered 1 s apart; they tell intrinsics only
  std::string source = {};  // the device that gave it, where the file says so: "DAVIS346_00000002"
};

// Largest side in pixels that a file may claim for a sensor: coordinates have 16 bits.
inline constexpr int kLargestSide_px = 65536;

// What one call of RecordingReader::read hands out, all of one stream: some events, some samples in the stream's
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
