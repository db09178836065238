// A recording for the stages: named streams that are read once, in packets.
#pragma once

#include "core/data/event.h"
#include "core/data/frame.h"
#include "core/data/imu_units.h"

#include "core/geometry/resolution.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// Faults of recordings that are reported but not repaired.

// In the order of their names.
enum class FaultKind {
  BackwardTime,
  BoardSize,
  Corrupt,
  Empty,
  Encoding,
  ExposureLeftOut,
  Gap,
  Guess,
  Held,
  HostClock,
  HotPixels,
  ImuLeftOut,
  Jitter,
  LostMessages,
  Metadata,
  NoIndex,
  NoResolution,
  NoStamps,
  NotFinite,
  Outside,
  OutsideResolution,
  Part,
  SaturatedAxis,
  SaturatedReadOut,
  SecondClock,
  StuckAxis,
  TimeWrap,
  Triggers,
  Truncated,
  Unit,
  Unreadable,
  Unsorted,
  Untimed,
};

// Names in reports and in `evical inspect`, in the enumeration's order.
inline constexpr std::array kFaultKinds{"backward_time", "board_size",     "corrupt",
                                        "empty",         "encoding",       "exposure_left_out",
                                        "gap",           "guess",          "held",
                                        "host_clock",    "hot_pixels",     "imu_left_out",
                                        "jitter",        "lost_messages",  "metadata",
                                        "no_index",      "no_resolution",  "no_stamps",
                                        "not_finite",    "outside",        "outside_resolution",
                                        "part",          "saturated_axis", "saturated_read_out",
                                        "second_clock",  "stuck_axis",     "time_wrap",
                                        "triggers",      "truncated",      "unit",
                                        "unreadable",    "unsorted",       "untimed"};
static_assert(kFaultKinds.size() == static_cast<std::size_t>(FaultKind::Untimed) + 1);

constexpr const char* nameOf(FaultKind kind) {
  return kFaultKinds[static_cast<std::size_t>(kind)];
}

// All faults of one kind that a reader found in one stream: a broken file has thousands.
inline constexpr std::ptrdiff_t kMostAlikeFaults = 10;

struct RecordingFault {
  std::string stream;  // empty: the file as a whole
  FaultKind kind = FaultKind::Corrupt;
  double at_s = 0.0;  // since the stream's first time; 0 if it has no time
  std::string text;   // message: one sentence
};

// Adds a fault unless it is already listed: detections of an earlier run may have it.
inline void addUnlessListed(const RecordingFault& fault, std::vector<RecordingFault>& faults) {
  const auto same = [&](const RecordingFault& known) { return known.text == fault.text; };
  if (std::ranges::none_of(faults, same)) faults.push_back(fault);
}

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
