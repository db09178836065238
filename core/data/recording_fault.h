// Faults of recordings that are reported but not repaired.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace evical {

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

}  // namespace evical
