// Slopes of the times at which edges pass, from planes through the burst times of neighbouring pixels
// (docs/maths.md, 16.1; R. Benosman et al., "Event-based visual flow", TNNLS 2014). Unlike normal_flow.h,
// edges do not have to cross the neighbourhood within a window: slow edges have as much time as fast ones.
#pragma once

#include "core/base/option_row.h"
#include "core/data/edge_slope.h"
#include "core/frontend/burst_window.h"
#include "core/frontend/edge_crossings.h"
#include "core/geometry/resolution.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace evical {

struct EdgeSlopeOptions {
  int radius_px;
  double max_error_px;
  double min_share;
  double max_crossing_s;
  double fastest_px_s;

  EdgeSlopeOptions();  // the defaults
  constexpr explicit EdgeSlopeOptions(NoDefaults) {}
  bool operator==(const EdgeSlopeOptions&) const = default;
  static const OptionTable<EdgeSlopeOptions>& table();
};

// Bursts in, slopes of consecutive windows of time out; bounded memory.
class EdgeSlopeFinder {
 public:
  // Slopes of bursts with begin_ns <= time < begin_ns + window; windows in order, including those without
  // slopes.
  using Sink = std::function<void(std::int64_t begin_ns, std::span<const EdgeSlope> slopes)>;

  EdgeSlopeFinder(Resolution resolution_px, const EdgeSlopeOptions& options, double window_s, Sink sink);

  // `complete_until_ns`: bursts before it have all been added (BurstExtractor::completeUntil_ns).
  void add(const std::vector<EdgeCrossing>& bursts, std::int64_t complete_until_ns);
  void finish();

 private:
  struct Neighbour {
    int dx, dy;
    double time_s;  // after the centre's
  };
  struct Plane {
    double a = 0.0, b = 0.0, c = 0.0;     // t = a x + b y + c
    double xx = 0.0, xy = 0.0, yy = 0.0;  // inverse of the sums about the mean
    int count = 0;
  };

  void runWindow(std::int64_t begin_ns);
  void sortByPixel();
  bool slopeAt(const EdgeCrossing& burst, EdgeSlope& slope);
  std::size_t slotOf(int x_px, int y_px, bool brighter) const;
  void nearestBursts(const EdgeCrossing& centre, const Plane& plane);
  bool fitPlane(double largest_error_s, Plane& plane) const;

  Resolution resolution_px_;
  EdgeSlopeOptions options_;
  std::int64_t window_ns_, margin_ns_;
  Sink sink_;
  BurstHistory history_;
  std::int64_t next_ns_ = std::numeric_limits<std::int64_t>::min(), newest_ns_ = next_ns_;
  std::vector<EdgeCrossing> gathered_;  // in the window and around it
  std::vector<std::uint32_t> begin_;    // by slot: of its times
  std::vector<std::int64_t> times_ns_;  // slot by slot
  std::vector<Neighbour> neighbours_;
  std::vector<EdgeSlope> slopes_;
};

}  // namespace evical
