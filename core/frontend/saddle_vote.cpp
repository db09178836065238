#include "core/frontend/saddle_vote.h"

#include "core/frontend/normal_flow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

namespace evical {
namespace {

using Direction = std::complex<float>;

constexpr float kNearest_px = 1.0f;  // nearer crossings have no direction

// A place that a crossing votes for, and the unit vector of the angle from there to the crossing.
struct VotedPlace {
  int dx, dy;
  Direction way;
};

std::vector<VotedPlace> placesWithin(double reach_px) {
  std::vector<VotedPlace> places;
  const int reach = static_cast<int>(std::ceil(reach_px));
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const auto distance = static_cast<float>(std::hypot(dx, dy));
      if (distance < kNearest_px || distance > static_cast<float>(reach_px)) continue;
      places.push_back({dx, dy, Direction(static_cast<float>(-dx), static_cast<float>(-dy)) / distance});
    }
  }
  return places;
}

class SaddleVotes {
 public:
  SaddleVotes(Resolution size_px, double reach_px)
      : size_px_(size_px),
        reach_px_(reach_px),
        pad_(static_cast<int>(std::ceil(reach_px)) + 1),
        stride_(size_px.width_px + 2 * pad_),
        sums_(static_cast<std::size_t>(stride_ * (size_px.height_px + 2 * pad_))),
        counts_(sums_.size(), 0.0f) {}

  void add(const std::vector<MovedCrossing>& crossings) {
    const std::vector<VotedPlace> places = placesWithin(reach_px_);
    for (const MovedCrossing& crossing : crossings) {
      const int x = static_cast<int>(std::lround(crossing.at_px.x())),
                y = static_cast<int>(std::lround(crossing.at_px.y()));
      if (x < 0 || y < 0 || x >= size_px_.width_px || y >= size_px_.height_px) continue;
      const Direction gradient(crossing.to_bright.x(), crossing.to_bright.y());
      for (const VotedPlace& place : places) {
        const std::size_t at = indexOf(x + place.dx, y + place.dy);
        // Only corners on the line along the edge: the way is perpendicular to the gradient.
        const float across =
            std::abs(place.way.real() * gradient.real() + place.way.imag() * gradient.imag());
        constexpr float kAlong = 0.5f;
        if (across > kAlong) continue;
        sums_[at] += place.way * gradient;
        counts_[at] += 1.0f;
      }
    }
  }

  std::vector<SaddleCandidate> peaks(const SaddleOptions& options) const {
    std::vector<SaddleCandidate> candidates;
    for (int y = 0; y < size_px_.height_px; ++y)
      for (int x = 0; x < size_px_.width_px; ++x)
        if (isPeak(x, y, options)) candidates.push_back(peakAt(x, y));
    std::sort(candidates.begin(), candidates.end(),
              [](const SaddleCandidate& a, const SaddleCandidate& b) { return a.score > b.score; });
    return candidates;
  }

 private:
  static constexpr int kNeighbourhood = 2;

  std::size_t indexOf(int x, int y) const {
    return static_cast<std::size_t>((y + pad_) * stride_ + x + pad_);
  }
  // Incoherent votes count less.
  float strength(int x, int y) const {
    const std::size_t at = indexOf(x, y);
    return counts_[at] > 0.0f ? std::norm(sums_[at]) / counts_[at] : 0.0f;
  }

  bool isPeak(int x, int y, const SaddleOptions& options) const {
    const float own = strength(x, y);
    const std::size_t at = indexOf(x, y);
    if (own < static_cast<float>(options.min_votes) ||
        std::abs(sums_[at]) < static_cast<float>(options.min_agreement) * counts_[at])
      return false;
    for (int dy = -kNeighbourhood; dy <= kNeighbourhood; ++dy)
      for (int dx = -kNeighbourhood; dx <= kNeighbourhood; ++dx) {
        const float other = strength(x + dx, y + dy);
        if (other > own || (other == own && (dy < 0 || (dy == 0 && dx < 0)))) return false;
      }
    return true;
  }

  SaddleCandidate peakAt(int x, int y) const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double weights = 0.0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const double w = std::pow(static_cast<double>(strength(x + dx, y + dy)), 2);
        sum += w * Eigen::Vector2d(dx, dy);
        weights += w;
      }
    return {Eigen::Vector2d(x, y) + sum / weights, static_cast<double>(std::arg(sums_[indexOf(x, y)])),
            static_cast<double>(strength(x, y))};
  }

  Resolution size_px_;
  double reach_px_;
  int pad_, stride_;
  std::vector<Direction> sums_;
  std::vector<float> counts_;
};

// Edges on both sides along at least one of the saddle's two lines: corners of single squares have one side
// only.
bool hasBothSides(const SaddleCandidate& candidate, const std::vector<const MovedCrossing*>& near,
                  double reach_px, int min_side) {
  std::array<int, 4> sides = {};
  for (const MovedCrossing* crossing : near) {
    const Eigen::Vector2d way = crossing->at_px.cast<double>() - candidate.at_px;
    const double distance_px = way.norm();
    if (distance_px < kNearest_px || distance_px > reach_px) continue;
    const double way_rad = std::atan2(way.y(), way.x()),
                 gradient_rad = std::atan2(static_cast<double>(crossing->to_bright.y()),
                                           static_cast<double>(crossing->to_bright.x()));
    constexpr double kAgrees_rad = 1.0;
    if (std::abs(wrapped_rad(way_rad + gradient_rad - candidate.phase_rad)) > kAgrees_rad) continue;
    const double first_rad = 0.5 * candidate.phase_rad + 0.25 * std::numbers::pi;
    const auto side = static_cast<int>(std::lround((way_rad - first_rad) / (0.5 * std::numbers::pi)));
    ++sides[static_cast<std::size_t>(((side % 4) + 4) % 4)];
  }
  return (sides[0] >= min_side && sides[2] >= min_side) || (sides[1] >= min_side && sides[3] >= min_side);
}

}  // namespace

std::vector<MovedCrossing> crossingsAtMiddle(const BurstWindow& window, const NormalFlowOptions& options) {
  const ActiveEventSurface surface(window, options.plane_radius_px, ActiveEventSurface::Kept::Nearest);
  std::vector<MovedCrossing> crossings;
  for (const NormalFlow& flow : estimateNormalFlow(surface, options)) {
    const float speed = flow.velocity_px_s.norm();
    // The window is long enough for slow edges. Of fast ones, crossings far from the middle are less
    // accurate.
    if (std::abs(flow.time_s) * speed > 0.5f * static_cast<float>(options.window_travel_px)) continue;
    const Eigen::Vector2f normal = flow.velocity_px_s / speed;
    // Darker: the edge moves towards its bright side.
    crossings.push_back({Eigen::Vector2f(flow.x_px, flow.y_px) - flow.time_s * flow.velocity_px_s,
                         flow.leading ? normal : Eigen::Vector2f(-normal), flow.velocity_px_s});
  }
  return crossings;
}

std::vector<SaddleCandidate> voteForSaddles(const std::vector<MovedCrossing>& crossings,
                                            Resolution resolution_px, double reach_px,
                                            const SaddleOptions& options) {
  SaddleVotes votes(resolution_px, reach_px);
  votes.add(crossings);
  std::vector<SaddleCandidate> candidates = votes.peaks(options);
  constexpr int kCell_px = 8;
  const int columns = resolution_px.width_px / kCell_px + 3, rows = resolution_px.height_px / kCell_px + 3;
  std::vector<std::vector<const MovedCrossing*>> cells(static_cast<std::size_t>(columns * rows));
  const auto cellOf = [&](double x, double y) {
    const int column = std::clamp(static_cast<int>(x) / kCell_px, 0, columns - 1),
              row = std::clamp(static_cast<int>(y) / kCell_px, 0, rows - 1);
    return static_cast<std::size_t>(row * columns + column);
  };
  for (const MovedCrossing& crossing : crossings)
    cells[cellOf(static_cast<double>(crossing.at_px.x()), static_cast<double>(crossing.at_px.y()))].push_back(
        &crossing);
  std::vector<const MovedCrossing*> near;
  std::erase_if(candidates, [&](const SaddleCandidate& candidate) {
    near.clear();
    for (double y = candidate.at_px.y() - reach_px - kCell_px; y <= candidate.at_px.y() + reach_px + kCell_px;
         y += kCell_px)
      for (double x = candidate.at_px.x() - reach_px - kCell_px;
           x <= candidate.at_px.x() + reach_px + kCell_px; x += kCell_px) {
        if (x < -kCell_px || y < -kCell_px) continue;
        const auto& cell = cells[cellOf(std::max(x, 0.0), std::max(y, 0.0))];
        near.insert(near.end(), cell.begin(), cell.end());
      }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    return !hasBothSides(candidate, near, reach_px, options.min_side);
  });
  if (candidates.size() > static_cast<std::size_t>(options.max_candidates))
    candidates.resize(static_cast<std::size_t>(options.max_candidates));
  return candidates;
}

}  // namespace evical
