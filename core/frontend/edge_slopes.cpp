#include "core/frontend/edge_slopes.h"

#include "core/base/option_table.h"
#include "core/base/time.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical {
namespace {

constexpr std::tuple kEdgeSlopeFields{
    Field{"radius_px", &EdgeSlopeOptions::radius_px, 2, within(1, 5), "px",
          "Half width of the neighbourhood of the plane fit."},
    Field{"max_error_px", &EdgeSlopeOptions::max_error_px, 0.6, within(0.05, 5.0), "px",
          "Largest deviation of a neighbour from the plane, as a distance that the edge travels."},
    Field{"min_share", &EdgeSlopeOptions::min_share, 0.6, within(0.2, 1.0), "",
          "Smallest share of inliers in the neighbourhood."},
    Field{"max_crossing_s", &EdgeSlopeOptions::max_crossing_s, 0.12, within(1e-3, 1.0), "s",
          "Longest time of an edge in the neighbourhood; slower edges may have changed their speed."},
    Field{"fastest_px_s", &EdgeSlopeOptions::fastest_px_s, 4000.0, within(10.0, 1e6), "px/s",
          "Largest speed of edges; faster ones are flicker of a lamp."}};
constexpr auto kEdgeSlopeDefaults = defaultsOf<EdgeSlopeOptions, kEdgeSlopeFields>();

constexpr int kRefits = 3;

}  // namespace

EdgeSlopeOptions::EdgeSlopeOptions() : EdgeSlopeOptions(kEdgeSlopeDefaults) {}

const OptionTable<EdgeSlopeOptions>& EdgeSlopeOptions::table() {
  static const OptionTable<EdgeSlopeOptions> table(kEdgeSlopeFields);
  return table;
}

EdgeSlopeFinder::EdgeSlopeFinder(Resolution resolution_px, const EdgeSlopeOptions& options, double window_s,
                                 Sink sink)
    : resolution_px_(resolution_px),
      options_(options),
      window_ns_(nanosecondsFrom(window_s)),
      margin_ns_(nanosecondsFrom(options.max_crossing_s)),
      sink_(std::move(sink)) {}

void EdgeSlopeFinder::add(const std::vector<EdgeCrossing>& bursts, std::int64_t complete_until_ns) {
  history_.add(bursts);
  for (const EdgeCrossing& burst : bursts) newest_ns_ = std::max(newest_ns_, burst.time_ns);
  if (history_.empty()) return;
  if (next_ns_ == std::numeric_limits<std::int64_t>::min()) {
    for (const EdgeCrossing& burst : bursts)
      next_ns_ = std::min(next_ns_ == std::numeric_limits<std::int64_t>::min() ? burst.time_ns : next_ns_,
                          burst.time_ns);
    // Bursts are in order of their ends: earlier medians may follow.
    next_ns_ = std::max(next_ns_ - margin_ns_, std::numeric_limits<std::int64_t>::min() + 2 * margin_ns_);
  }
  while (next_ns_ + window_ns_ + margin_ns_ <= std::min(complete_until_ns, newest_ns_)) {
    runWindow(next_ns_);
    next_ns_ += window_ns_;
    history_.dropBefore(next_ns_ - margin_ns_);
  }
}

void EdgeSlopeFinder::finish() {
  if (next_ns_ == std::numeric_limits<std::int64_t>::min()) return;
  for (; next_ns_ <= newest_ns_; next_ns_ += window_ns_) runWindow(next_ns_);
}

void EdgeSlopeFinder::runWindow(std::int64_t begin_ns) {
  gathered_.clear();
  slopes_.clear();
  history_.gather(begin_ns - margin_ns_, begin_ns + window_ns_ + margin_ns_, gathered_);
  if (!gathered_.empty()) {
    sortByPixel();
    for (const EdgeCrossing& burst : gathered_) {
      if (burst.time_ns < begin_ns || burst.time_ns >= begin_ns + window_ns_) continue;
      EdgeSlope slope;
      if (slopeAt(burst, slope)) slopes_.push_back(slope);
    }
  }
  sink_(begin_ns, slopes_);
}

std::size_t EdgeSlopeFinder::slotOf(int x_px, int y_px, bool brighter) const {
  return 2 * static_cast<std::size_t>(y_px * resolution_px_.width_px + x_px) + (brighter ? 1 : 0);
}

void EdgeSlopeFinder::sortByPixel() {
  begin_.assign(2 * static_cast<std::size_t>(resolution_px_.pixelCount()) + 2, 0);
  for (const EdgeCrossing& burst : gathered_) ++begin_[slotOf(burst.x_px, burst.y_px, burst.brighter) + 2];
  for (std::size_t k = 2; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  times_ns_.resize(gathered_.size());
  for (const EdgeCrossing& burst : gathered_)
    times_ns_[begin_[slotOf(burst.x_px, burst.y_px, burst.brighter) + 1]++] = burst.time_ns;
}

// The burst nearest to the plane, for each pixel around the centre.
void EdgeSlopeFinder::nearestBursts(const EdgeCrossing& centre, const Plane& plane) {
  neighbours_.clear();
  const int r = options_.radius_px;
  for (int dy = -r; dy <= r; ++dy) {
    for (int dx = -r; dx <= r; ++dx) {
      const std::size_t slot = slotOf(centre.x_px + dx, centre.y_px + dy, centre.brighter);
      const double expected_s = plane.a * dx + plane.b * dy + plane.c;
      double nearest_s = std::numeric_limits<double>::infinity();
      for (std::uint32_t k = begin_[slot]; k < begin_[slot + 1]; ++k) {
        const double time_s = 1e-9 * static_cast<double>(times_ns_[k] - centre.time_ns);
        if (std::abs(time_s - expected_s) < std::abs(nearest_s - expected_s)) nearest_s = time_s;
      }
      if (std::abs(nearest_s) <= options_.max_crossing_s) neighbours_.push_back({dx, dy, nearest_s});
    }
  }
}

// False if those near the plane are too few, or collinear.
bool EdgeSlopeFinder::fitPlane(double largest_error_s, Plane& plane) const {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0, t = 0.0, xt = 0.0, yt = 0.0;
  for (const Neighbour& at : neighbours_) {
    if (std::abs(at.time_s - plane.a * at.dx - plane.b * at.dy - plane.c) > largest_error_s) continue;
    n += 1.0;
    x += at.dx;
    y += at.dy;
    xx += at.dx * at.dx;
    xy += at.dx * at.dy;
    yy += at.dy * at.dy;
    t += at.time_s;
    xt += at.dx * at.time_s;
    yt += at.dy * at.time_s;
  }
  const int side = 2 * options_.radius_px + 1;
  plane.count = static_cast<int>(n);
  if (n < options_.min_share * side * side) return false;
  xx -= x * x / n;
  xy -= x * y / n;
  yy -= y * y / n;
  xt -= x * t / n;
  yt -= y * t / n;
  const double determinant = xx * yy - xy * xy;
  if (determinant < 0.5) return false;
  plane.xx = yy / determinant;
  plane.xy = -xy / determinant;
  plane.yy = xx / determinant;
  plane.a = plane.xx * xt + plane.xy * yt;
  plane.b = plane.xy * xt + plane.yy * yt;
  plane.c = (t - plane.a * x - plane.b * y) / n;
  return true;
}

bool EdgeSlopeFinder::slopeAt(const EdgeCrossing& burst, EdgeSlope& slope) {
  const int r = options_.radius_px;
  if (burst.x_px < r || burst.y_px < r || burst.x_px + r >= resolution_px_.width_px ||
      burst.y_px + r >= resolution_px_.height_px)
    return false;
  Plane plane;
  nearestBursts(burst, plane);
  if (!fitPlane(std::numeric_limits<double>::infinity(), plane)) return false;
  for (int refit = 0; refit < kRefits; ++refit) {
    nearestBursts(burst, plane);
    const double largest_error_s = options_.max_error_px * std::hypot(plane.a, plane.b);
    if (!fitPlane(largest_error_s, plane)) return false;
  }
  const double slope_s_px = std::hypot(plane.a, plane.b);
  const double crossing_s = 2.0 * r * (std::abs(plane.a) + std::abs(plane.b));
  if (slope_s_px * options_.fastest_px_s < 1.0 || crossing_s > options_.max_crossing_s) return false;
  slope.time_ns = burst.time_ns;
  slope.x_px = burst.x_px;
  slope.y_px = burst.y_px;
  slope.slope_s_px = Eigen::Vector2d(plane.a, plane.b).cast<float>();
  slope.shape = Eigen::Vector3d(plane.xx, plane.xy, plane.yy).cast<float>();
  return true;
}

}  // namespace evical
