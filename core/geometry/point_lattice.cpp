#include "core/geometry/point_lattice.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <queue>
#include <utility>

namespace evical {
namespace {

constexpr std::size_t kNobody = static_cast<std::size_t>(-1);
constexpr int kLargestIndex = 200;

struct Steps {
  Eigen::Vector2d a, b;
};

double cross(const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
  return u.x() * v.y() - u.y() * v.x();
}

bool alike(const LatticeCircle& a, const LatticeCircle& b, const LatticeOptions& options) {
  const double ratio = a.radius_px / b.radius_px;
  return ratio < options.largest_radius_ratio && ratio > 1.0 / options.largest_radius_ratio;
}

std::vector<std::size_t> neighboursOf(std::size_t seed, const std::vector<LatticeCircle>& circles,
                                      const LatticeOptions& options) {
  std::vector<std::pair<double, std::size_t>> near;
  const LatticeCircle& centre = circles[seed];
  for (std::size_t k = 0; k < circles.size(); ++k) {
    if (k == seed || !alike(centre, circles[k], options)) continue;
    const double distance = (circles[k].centre_px - centre.centre_px).norm();
    if (distance < options.shortest_step_radii * centre.radius_px) continue;
    if (distance > options.longest_step_radii * centre.radius_px) continue;
    near.emplace_back(distance, k);
  }
  std::sort(near.begin(), near.end());
  constexpr std::size_t kMost = 8;
  std::vector<std::size_t> indices;
  for (std::size_t n = 0; n < std::min(near.size(), kMost); ++n) indices.push_back(near[n].second);
  return indices;
}

std::size_t nearestTo(const Eigen::Vector2d& place, double tolerance_px, const LatticeCircle& like,
                      const std::vector<LatticeCircle>& circles, const std::vector<bool>& used,
                      const LatticeOptions& options) {
  std::size_t best = kNobody;
  double best_distance = tolerance_px;
  for (std::size_t k = 0; k < circles.size(); ++k) {
    if (used[k] || !alike(like, circles[k], options)) continue;
    const double distance = (circles[k].centre_px - place).norm();
    if (distance < best_distance) {
      best_distance = distance;
      best = k;
    }
  }
  return best;
}

CircleLattice grow(std::size_t seed, const Steps& first, const std::vector<LatticeCircle>& circles,
                   const LatticeOptions& options) {
  constexpr std::array<std::pair<int, int>, 4> kWays = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  CircleLattice lattice = {{0, 0, seed}};
  std::map<std::pair<int, int>, std::size_t> node_at = {{{0, 0}, 0}};
  std::vector<Steps> steps = {first};
  std::vector<bool> used(circles.size(), false);
  used[seed] = true;
  for (std::size_t n = 0; n < lattice.size(); ++n) {
    const LatticeNode node = lattice[n];
    const Steps local = steps[n];
    const LatticeCircle& centre = circles[node.circle];
    for (const auto& [di, dj] : kWays) {
      const std::pair<int, int> place{node.i + di, node.j + dj};
      if (node_at.contains(place) || std::abs(place.first) > kLargestIndex ||
          std::abs(place.second) > kLargestIndex)
        continue;
      const Eigen::Vector2d step = di * local.a + dj * local.b;
      const std::size_t found = nearestTo(centre.centre_px + step, options.step_tolerance * step.norm(),
                                          centre, circles, used, options);
      if (found == kNobody) continue;
      const Eigen::Vector2d actual = circles[found].centre_px - centre.centre_px;
      Steps updated = local;
      Eigen::Vector2d& mine = di != 0 ? updated.a : updated.b;
      mine = 0.4 * mine + 0.6 * (di + dj) * actual;
      node_at[place] = lattice.size();
      lattice.push_back({place.first, place.second, found});
      steps.push_back(updated);
      used[found] = true;
    }
  }
  return lattice;
}

}  // namespace

CircleLattice findCircleLattice(const std::vector<LatticeCircle>& circles, const LatticeOptions& options) {
  CircleLattice best;
  std::vector<bool> settled(circles.size(), false);
  for (std::size_t seed = 0; seed < circles.size(); ++seed) {
    if (settled[seed]) continue;  // already part of another lattice
    const std::vector<std::size_t> near = neighboursOf(seed, circles, options);
    CircleLattice best_here;
    for (const std::size_t p : near) {
      for (const std::size_t q : near) {
        const Eigen::Vector2d a = circles[p].centre_px - circles[seed].centre_px;
        const Eigen::Vector2d b = circles[q].centre_px - circles[seed].centre_px;
        if (cross(a, b) < options.least_sine * a.norm() * b.norm()) continue;
        CircleLattice lattice = grow(seed, {a, b}, circles, options);
        if (lattice.size() > best_here.size()) best_here = std::move(lattice);
      }
    }
    if (best_here.size() >= static_cast<std::size_t>(options.least_circles)) {
      for (const LatticeNode& node : best_here) settled[node.circle] = true;
    }
    if (best_here.size() > best.size()) best = std::move(best_here);
  }
  return best;
}

}  // namespace evical
