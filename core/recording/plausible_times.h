// Rates and lengths that streams of recordings can have: one table for all readers. Times beyond it have
// another unit than the reader assumes, or are not times. Used before any other conclusion, since all others
// depend on times.
#pragma once

#include "core/data/recording.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// Times of one stream in the order of recording, as far as their plausibility depends on them.
class SeenTimes {
 public:
  // An item, or the last of several that follow the one before.
  void add(std::int64_t time_ns, std::uint64_t items = 1);
  void add(const Packet& packet);
  void reach(const Event& event);  // a pixel with events

  std::uint64_t count() const { return count_; }
  double span_s() const { return span_s_; }  // sum of all steps forwards
  double mean_s() const;                     // interval; strays and gaps increase it
  double median_s() const;                   // interval; of the first few thousand
  double pixels() const;                     // area that events reach

 private:
  std::uint64_t count_ = 0;
  std::int64_t last_ns_ = 0;
  double span_s_ = 0.0;
  Resolution reached_px_;
  std::vector<double> intervals_s_;
};

// Why the times of a stream cannot be true, as a sentence with the unit that would make them true; absent if
// they are plausible or too few to tell.
std::optional<std::string> whyImplausible(StreamType type, const SeenTimes& seen);

// True if a camera can take pictures at these times, or there is only one.
bool areTimesOfPictures(std::vector<std::int64_t> times_ns);

}  // namespace evical
