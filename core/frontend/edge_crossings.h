// An edge that crosses a pixel fires a burst of events of one polarity. The burst's median is the time at
// which the edge was in the middle of the pixel, much more accurately than its first event
// (docs/maths.md, 4).
#pragma once

#include "core/data/event.h"
#include "core/frontend/detection_options.h"
#include "core/frontend/pixel_level.h"
#include "core/geometry/resolution.h"

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <vector>

namespace evical {

struct EdgeCrossing {
  std::int64_t time_ns;      // median of its events' times, including those missing at a turning edge
  std::int32_t duration_ns;  // from its first to its last event
  std::uint16_t x_px, y_px;
  std::uint16_t events;  // number that an edge without turning fires here
  bool brighter;
};

// Longest delay between a burst's median and its output.
double longestHandOut_s(const BurstOptions& options);

// Converts events to bursts, in one pass and constant memory. A burst ends with an event of the other
// polarity or with a pause that is long compared with its mean interval. Bursts in which the edge was not in
// the middle of its pixel are discarded.
class BurstExtractor {
 public:
  BurstExtractor(Resolution resolution_px, const BurstOptions& options);

  // Events in time order, inside the resolution; finished bursts are appended to `bursts`,
  // in order of their ends.
  void add(EventSpan events, std::vector<EdgeCrossing>& bursts);
  void finish(std::vector<EdgeCrossing>& bursts);

  // Bursts with a median before this time have all been output.
  std::int64_t completeUntil_ns() const { return complete_until_ns_; }
  std::uint64_t eventCount() const { return event_count_; }

 private:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min() / 2;
  static constexpr int kKeptTimes = 16;  // thinned by halves when a burst has more events

  // Half a cache line, with a line for its times: an event touches these two.
  struct alignas(32) Pixel {
    std::int64_t first_ns = 0;
    std::int32_t length_ns = 0;  // from the first event to the last
    std::uint16_t events = 0;    // 0: no current burst
    std::uint8_t kept = 0;
    std::uint8_t stride_log2 : 7 = 0;
    bool brighter : 1 = false;
    std::int64_t quiet_since_ns = kNever;  // last event of the burst before
    PixelLevel level;

    std::int64_t last_ns() const { return first_ns + length_ns; }
  };
  static_assert(sizeof(Pixel) == 32);
  struct alignas(64) KeptTimes : std::array<std::int32_t, kKeptTimes> {
  };  // since the first event, which is at 0
  struct Burst {
    Pixel& pixel;
    const KeptTimes& times_ns;

    std::int64_t timeOf_ns(double kept_event) const;  // interpolated between two kept ones
  };
  struct Check {
    std::uint32_t pixel;
    std::int64_t at_ns;
  };

  std::uint32_t indexOf(const Event& event) const;
  void fetch(std::uint32_t index) const;
  void start(std::uint32_t index, const Event& event);
  void extend(std::uint32_t index, const Event& event);
  void end(std::uint32_t index, std::int64_t now_ns, std::vector<EdgeCrossing>& bursts);
  int ownBegin(const Burst& burst) const;
  bool pausedAt(const Pixel& pixel, std::int64_t time_ns) const;
  bool restedAt(const Burst& burst, std::int64_t time_ns) const;
  void endPaused(std::int64_t now_ns, std::vector<EdgeCrossing>& bursts);

  Resolution resolution_px_;
  std::int64_t longest_gap_ns_, shortest_gap_ns_, longest_burst_ns_, check_interval_ns_, hand_out_ns_;
  double gap_to_pace_;
  int least_events_;
  std::vector<Pixel> pixels_;
  std::vector<KeptTimes> times_ns_;  // by pixel
  std::deque<Check> checks_;
  std::int64_t complete_until_ns_, last_event_ns_ = kNever;
  std::uint64_t event_count_ = 0;
};

}  // namespace evical
