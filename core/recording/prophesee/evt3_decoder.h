// EVT3, the 16-bit words of Prophesee sensors, in RAW files and in ROS messages. Words refer to earlier
// ones, so one decoder reads one camera's words from the start, in blocks of any size.
// Source: docs.prophesee.ai, "EVT 3.0 format".
#pragma once

#include "core/data/event.h"

#include "core/geometry/resolution.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace evical {

// Counts of everything except the decoded events.
struct Evt3Counts {
  std::uint64_t triggers = 0;
  std::uint64_t outside = 0;   // events beyond the sensor; dropped
  std::uint64_t unplaced = 0;  // words of events before both time words, y or the base of x; dropped
};

class Evt3Decoder {
 public:
  // Everything that fits into 11 bits if the resolution is unknown.
  explicit Evt3Decoder(Resolution resolution_px = {}) { setResolution(resolution_px); }
  void setResolution(Resolution resolution_px);

  // Appends the events of these little-endian words; an odd last byte is ignored. Times are the sensor's,
  // without its wraps every 16.777 s; they start anywhere in 0..16.777 s.
  void decode(std::string_view words, std::vector<Event>& events);

  // Words were lost: events have no position until a word states one. The time continues.
  void forgetPosition();

  const Evt3Counts& counts() const { return counts_; }

 private:
  void setTimeHigh(std::uint32_t high);
  void setTimeLow(std::uint32_t low);
  void addEvent(std::uint16_t word, std::vector<Event>& events);
  void addVector(std::uint32_t mask, int width, std::vector<Event>& events);

  std::uint32_t width_px_ = 0, height_px_ = 0;
  bool has_high_ = false, has_low_ = false, has_y_ = false, has_base_ = false;
  std::uint32_t high_ = 0, low_ = 0;
  std::int64_t wraps_us_ = 0;
  std::int64_t time_ns_ = 0;
  std::uint32_t y_px_ = 0, base_px_ = 0;
  bool base_brighter_ = false;
  Evt3Counts counts_;
};

}  // namespace evical
