// An edge that crosses a pixel fires a burst of events of one polarity. The burst's median is the time at
// which the edge was in the middle of the pixel, much more accurately than its first event
// (docs/maths.md, 4).
#pragma once

#include "core/frontend/detection_options.h"

#include "core/data/board_observations.h"
#include "core/data/event.h"
#include "core/geometry/board.h"
#include "core/geometry/resolution.h"

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

namespace evical {

// Level of a pixel between its darkest and its brightest; every event is a step of it. The level determines
// when an edge that turned back before leaving the pixel, or had not left it before, was in the pixel's
// middle (docs/maths.md, 4.1).

// Data of a pixel's burst for its level.
struct LevelBurst {
  bool brighter;
  int events;
  bool cut_begin;                    // events before it were considered noise
  bool rested_before, rested_after;  // the edge was out of the pixel's reach
};

class PixelLevel {
 public:
  struct Middle {
    double event;      // with the edge in the pixel's middle: from 0, fractional between two events
    int whole_events;  // estimated number of events of an edge that crosses the pixel completely
  };

  // Empty if the edge was not in the middle during the burst. Bursts with unknown time before or after are
  // treated as complete.
  std::optional<Middle> pass(const LevelBurst& burst);
  // Update by events that are too few for a burst.
  void step(bool brighter, int events);

 private:
  static constexpr float kUnknown = -1.0f;

  // Number of a complete burst's events that the edge had already fired at its present place.
  std::optional<double> had(const LevelBurst& burst) const;
  void set(bool brighter, double part) { level_ = static_cast<float>(brighter ? part : 1.0 - part); }

  std::array<std::uint16_t, 2> whole_ = {0,
                                         0};  // events of the last complete burst, by polarity; 0: none yet
  float level_ = kUnknown;                    // 0 dark, 1 bright
};

struct EdgeCrossing {
  std::int64_t time_ns;      // median of its events' times, including those missing at a turning edge
  std::int32_t duration_ns;  // from its first to its last event
  std::uint16_t x_px, y_px;
  std::uint16_t events;  // number that an edge without turning fires here; 0: too few for a burst
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
  int min_events_;
  bool single_events_;
  std::vector<Pixel> pixels_;
  std::vector<KeptTimes> times_ns_;  // by pixel
  std::deque<Check> checks_;
  std::int64_t complete_until_ns_, last_event_ns_ = kNever;
  std::uint64_t event_count_ = 0;
};

// Delay of pixels for edges that brighten them, minus that for edges that darken them: a sign of low light,
// or of slow biases. Bursts are behind their edge by the pixel's delay times the edge's speed. Of a circle's
// leading and trailing edges one brightens and one darkens, so circles seem to grow or to shrink in
// proportion to their speed:
//   radius offset = r0 + s (d_brightening - d_darkening) / 2 * speed,  s = 1 for dark circles, -1 for bright
//   ones.
// docs/maths.md, 10.1.
class PolarityDelayFit {
 public:
  // Adds one window: the speed of the board's image, and the distance of bursts outside the circles' edges,
  // both in the sensor's pixels. Edges that hardly move are ignored.
  void add(double speed_px_s, double radius_offset_px);

  // Empty for few windows, or for one speed. The sigma assumes independent errors of windows.
  std::optional<PolarityDelay> result(CircleShade shade) const;

 private:
  double count_ = 0.0, speed_ = 0.0, offset_ = 0.0;  // sums
  double speed2_ = 0.0, offset2_ = 0.0, product_ = 0.0;
};

}  // namespace evical
