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
  return ratio < options.max_radius_ratio && ratio > 1.0 / options.max_radius_ratio;
}

std::vector<std::size_t> neighboursOf(std::size_t seed, const std::vector<LatticeCircle>& circles,
                                      const LatticeOptions& options) {
  std::vector<std::pair<double, std::size_t>> near;
  const LatticeCircle& centre = circles[seed];
  for (std::size_t k = 0; k < circles.size(); ++k) {
    if (k == seed || !alike(centre, circles[k], options)) continue;
    const double distance = (circles[k].centre_px - centre.centre_px).norm();
    if (distance < options.min_step_radii * centre.radius_px) continue;
    if (distance > options.max_step_radii * centre.radius_px) continue;
    near.emplace_back(distance, k);
  }
  std::sort(near.begin(), near.end());
  constexpr std::size_t kMax = 8;
  std::vector<std::size_t> indices;
  for (std::size_t n = 0; n < std::min(near.size(), kMax); ++n) indices.push_back(near[n].second);
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
        if (cross(a, b) < options.min_sine * a.norm() * b.norm()) continue;
        CircleLattice lattice = grow(seed, {a, b}, circles, options);
        if (lattice.size() > best_here.size()) best_here = std::move(lattice);
      }
    }
    if (best_here.size() >= static_cast<std::size_t>(options.min_circles)) {
      for (const LatticeNode& node : best_here) settled[node.circle] = true;
    }
    if (best_here.size() > best.size()) best = std::move(best_here);
  }
  return best;
}

namespace {

struct Shifted {
  LatticeMap map;
  LatticePlace shift;
  int count;
};

// Rotations of the lattice, each also sheared: the shortest steps of a tilted board may not be the sides of
// its squares.
std::vector<LatticeMap> latticeMaps() {
  constexpr std::array<LatticeMap, 5> kShears = {
      {{1, 0, 0, 1}, {1, 1, 0, 1}, {1, -1, 0, 1}, {1, 0, 1, 1}, {1, 0, -1, 1}}};
  std::vector<LatticeMap> maps;
  for (const LatticeMap& s : kShears) {
    for (const LatticeMap& t : kLatticeTurns) {
      maps.push_back({t[0] * s[0] + t[1] * s[2], t[0] * s[1] + t[1] * s[3],  //
                      t[2] * s[0] + t[3] * s[2], t[2] * s[1] + t[3] * s[3]});
    }
  }
  return maps;
}

std::vector<Shifted> bestShifts(const CircleLattice& lattice, const std::map<LatticePlace, int>& board,
                                double nearly) {
  std::vector<Shifted> shifts;
  int best = 0;
  for (const LatticeMap& map : latticeMaps()) {
    std::map<LatticePlace, int> counts;
    for (const LatticeNode& node : lattice) {
      const LatticePlace at = applied(map, {node.i, node.j});
      for (const auto& [place, circle] : board) ++counts[{place.first - at.first, place.second - at.second}];
    }
    for (const auto& [shift, count] : counts) {
      best = std::max(best, count);
      shifts.push_back({map, shift, count});
    }
  }
  std::erase_if(shifts, [&](const Shifted& s) { return s.count < nearly * best; });
  std::sort(shifts.begin(), shifts.end(),
            [](const Shifted& a, const Shifted& b) { return a.count > b.count; });
  return shifts;
}

}  // namespace

LatticePlace applied(const LatticeMap& map, const LatticePlace& place) {
  return {map[0] * place.first + map[1] * place.second, map[2] * place.first + map[3] * place.second};
}

std::map<LatticePlace, int> boardLattice(const Board& board) {
  std::map<LatticePlace, int> lattice;
  for (int row = 0; row < board.rows; ++row) {
    for (int col = 0; col < board.cols; ++col) {
      const int x = 2 * col + row % 2, y = row;
      const bool asymmetric = board.type == BoardType::AsymmetricCircles;
      const LatticePlace place = asymmetric ? LatticePlace{(x - y) / 2, (x + y) / 2} : LatticePlace{col, row};
      lattice[place] = board.index(row, col);
    }
  }
  return lattice;
}

std::vector<LatticePlacement> layOnBoard(const CircleLattice& lattice, const Board& board, double nearly) {
  const std::map<LatticePlace, int> places = boardLattice(board);
  std::vector<LatticePlacement> placements;
  for (const Shifted& shifted : bestShifts(lattice, places, nearly)) {
    LatticePlacement& placement = placements.emplace_back(LatticePlacement{shifted.map, {}});
    for (const LatticeNode& node : lattice) {
      const LatticePlace at = applied(shifted.map, {node.i, node.j});
      const auto found = places.find({at.first + shifted.shift.first, at.second + shifted.shift.second});
      if (found != places.end()) placement.circles.emplace_back(found->second, node.circle);
    }
  }
  return placements;
}

}  // namespace evical
