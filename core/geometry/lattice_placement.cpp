#include "core/geometry/lattice_placement.h"

#include <algorithm>

namespace evical {
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
