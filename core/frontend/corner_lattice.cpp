#include "core/frontend/corner_lattice.h"

#include "core/geometry/camera_model.h"
#include "core/geometry/homography.h"
#include "core/numerics/robust.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace evical {
namespace {

constexpr int kLargestIndex = 100;
constexpr std::size_t kMaxSeeds = 400;
constexpr std::size_t kNeighbours = 10;
constexpr double kMaxSideRatio = 2.5;   // of a tilted square
constexpr double kSeedTolerance = 0.3;  // of the fourth corner, relative to a side

double crossProduct(const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
  return u.x() * v.y() - u.y() * v.x();
}

bool isOpposite(const SaddleCandidate& a, const SaddleCandidate& b) {
  constexpr double kTolerance_rad = 1.0;
  return std::abs(wrapped_rad(a.phase_rad - b.phase_rad + std::numbers::pi)) < kTolerance_rad;
}

bool isAlike(const SaddleCandidate& a, const SaddleCandidate& b) {
  constexpr double kTolerance_rad = 1.0;
  return std::abs(wrapped_rad(a.phase_rad - b.phase_rad)) < kTolerance_rad;
}

// True if ink is between the directions `a` and `b` of a saddle's lines, b being a quarter turn after a.
bool isDarkBetween(const SaddleCandidate& saddle, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d middle = a.normalized() + b.normalized();
  const double middle_rad = std::atan2(middle.y(), middle.x());
  return std::abs(wrapped_rad(saddle.phase_rad - (2.0 * middle_rad - std::numbers::pi))) <
         0.5 * std::numbers::pi;
}

// Distance of a line of corners from the first one.
double lineAt_m(const Board& board, int line) {
  if (board.type != BoardType::AprilGrid) return line * board.spacing_m;
  const int tag = line >= 0 ? line / 2 : (line - 1) / 2;
  return tag * board.spacing_m + (line - 2 * tag) * board.tag_size_m;
}

// Growth of a lattice from four corners of a square, each step predicted by the nodes around it.
class LatticeGrowth {
 public:
  LatticeGrowth(const std::vector<SaddleCandidate>& saddles, const Board& board, const GridOptions& options)
      : saddles_(saddles), board_(board), options_(options), used_(saddles.size(), false) {
    sortIntoCells();
  }

  std::vector<CornerNode> from(const std::array<std::size_t, 4>& square, int first_line) {
    std::fill(used_.begin(), used_.end(), false);
    nodes_.clear();
    at_.clear();
    constexpr std::array<std::pair<int, int>, 4> kSquare = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (std::size_t k = 0; k < square.size(); ++k)
      add(first_line + kSquare[k].first, first_line + kSquare[k].second, square[k]);
    constexpr std::array<std::pair<int, int>, 4> kWays = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      for (const auto& [di, dj] : kWays) {
        const int i = nodes_[n].i + di, j = nodes_[n].j + dj;
        if (at_.contains({i, j}) || std::abs(i) > kLargestIndex || std::abs(j) > kLargestIndex) continue;
        const std::optional<std::size_t> found = lookFor(i, j, nodes_[n]);
        if (found) add(i, j, *found);
      }
    }
    return nodes_;
  }

 private:
  static constexpr int kCell_px = 8;

  void sortIntoCells() {
    for (std::size_t k = 0; k < saddles_.size(); ++k) cells_[cellOf(saddles_[k].at_px)].push_back(k);
  }
  static std::pair<int, int> cellOf(const Eigen::Vector2d& at_px) {
    return {static_cast<int>(std::floor(at_px.x() / kCell_px)),
            static_cast<int>(std::floor(at_px.y() / kCell_px))};
  }

  void add(int i, int j, std::size_t saddle) {
    at_[{i, j}] = nodes_.size();
    nodes_.push_back({i, j, saddle});
    used_[saddle] = true;
  }

  Eigen::Vector2d placeOf_m(int i, int j) const { return {lineAt_m(board_, i), lineAt_m(board_, j)}; }

  std::optional<std::size_t> lookFor(int i, int j, const CornerNode& from) const {
    // Affine map from the board's plane, from the nodes around the place.
    constexpr int kReach = 3;
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 2> products = Eigen::Matrix<double, 3, 2>::Zero();
    const Eigen::Vector2d middle_m = placeOf_m(i, j);
    for (int dj = -kReach; dj <= kReach; ++dj) {
      for (int di = -kReach; di <= kReach; ++di) {
        const auto found = at_.find({i + di, j + dj});
        if (found == at_.end()) continue;
        const Eigen::Vector2d away = (placeOf_m(i + di, j + dj) - middle_m) / board_.spacing_m;
        const double weight = 1.0 / std::pow(0.2 + away.squaredNorm(), 2);
        const Eigen::Vector3d row(1.0, away.x(), away.y());
        squares += weight * row * row.transpose();
        products += weight * row * saddles_[nodes_[found->second].saddle].at_px.transpose();
      }
    }
    const Eigen::LDLT<Eigen::Matrix3d> solver(squares);
    if (!(solver.vectorD().minCoeff() > 1e-6)) return std::nullopt;
    const Eigen::Matrix<double, 3, 2> map = solver.solve(products);
    const Eigen::Vector2d place_px = map.row(0).transpose();
    const double px_per_spacing = std::min(map.row(1).norm(), map.row(2).norm());
    return nearest(place_px, options_.step_tolerance * smallestStep() * px_per_spacing, i, j, from);
  }

  // Relative to the spacing.
  double smallestStep() const {
    if (board_.type != BoardType::AprilGrid) return 1.0;
    return std::min(board_.tag_size_m, board_.spacing_m - board_.tag_size_m) / board_.spacing_m;
  }

  std::optional<std::size_t> nearest(const Eigen::Vector2d& place_px, double tolerance_px, int i, int j,
                                     const CornerNode& from) const {
    const SaddleCandidate& like = saddles_[from.saddle];
    const bool alike = (i - from.i + j - from.j) % 2 == 0;
    double best_px = std::max(tolerance_px, 1.5);
    std::optional<std::size_t> best;
    const auto [column, row] = cellOf(place_px);
    const int reach = static_cast<int>(best_px) / kCell_px + 1;
    for (int y = row - reach; y <= row + reach; ++y) {
      for (int x = column - reach; x <= column + reach; ++x) {
        const auto cell = cells_.find({x, y});
        if (cell == cells_.end()) continue;
        for (const std::size_t k : cell->second) {
          const double distance_px = (saddles_[k].at_px - place_px).norm();
          if (used_[k] || distance_px >= best_px) continue;
          if (!(alike ? isAlike(like, saddles_[k]) : isOpposite(like, saddles_[k]))) continue;
          best_px = distance_px;
          best = k;
        }
      }
    }
    return best;
  }

  const std::vector<SaddleCandidate>& saddles_;
  const Board& board_;
  const GridOptions& options_;
  std::map<std::pair<int, int>, std::vector<std::size_t>> cells_;
  std::vector<bool> used_;
  std::vector<CornerNode> nodes_;
  std::map<std::pair<int, int>, std::size_t> at_;
};

// Brightness gradients of a window's crossings, pixel by pixel.
class GradientPicture {
 public:
  GradientPicture(const std::vector<MovedCrossing>& crossings, Resolution size_px)
      : width_(size_px.width_px),
        height_(size_px.height_px),
        sums_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), Eigen::Vector2f::Zero()) {
    for (const MovedCrossing& crossing : crossings) {
      const int x = static_cast<int>(std::lround(crossing.at_px.x())),
                y = static_cast<int>(std::lround(crossing.at_px.y()));
      if (isInside(x, y)) sums_[static_cast<std::size_t>(y * width_ + x)] += crossing.to_bright;
    }
  }

  // Share of the middle half of a line along which there are edges that are bright on its side `to_bright`
  // (unit), minus the share of the opposite ones.
  double support(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                 const Eigen::Vector2d& to_bright) const {
    const int steps = std::max(3, static_cast<int>(std::ceil(0.5 * (to - from).norm())));
    const Eigen::Vector2f normal = to_bright.cast<float>();
    int agreeing = 0;
    for (int k = 0; k < steps; ++k) {
      const Eigen::Vector2d at = from + (0.25 + 0.5 * k / (steps - 1)) * (to - from);
      float sum = 0.0f;
      for (const double across_px : {-1.0, 0.0, 1.0}) {
        const Eigen::Vector2d beside = at + across_px * to_bright;
        const int x = static_cast<int>(std::lround(beside.x())),
                  y = static_cast<int>(std::lround(beside.y()));
        if (isInside(x, y)) sum += sums_[static_cast<std::size_t>(y * width_ + x)].dot(normal);
      }
      constexpr float kEdge = 0.5f;
      agreeing += (sum > kEdge) - (sum < -kEdge);
    }
    return static_cast<double>(agreeing) / steps;
  }

 private:
  bool isInside(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }

  int width_, height_;
  std::vector<Eigen::Vector2f> sums_;
};

// True if edges are along two opposite sides of a square, dark or bright inside, and none contradicts. Motion
// along a side leaves it without events.
bool hasSides(const std::array<Eigen::Vector2d, 4>& square, bool dark, const GradientPicture& picture) {
  constexpr double kSupported = 0.6, kContradicted = -0.3;
  const Eigen::Vector2d middle = 0.25 * (square[0] + square[1] + square[2] + square[3]);
  std::array<double, 4> sides = {};
  for (std::size_t k = 0; k < square.size(); ++k) {
    const Eigen::Vector2d &from = square[k], &to = square[(k + 1) % square.size()];
    Eigen::Vector2d normal = (to - from).unitOrthogonal();
    if ((normal.dot(0.5 * (from + to) - middle) > 0.0) != dark) normal = -normal;
    sides[k] = picture.support(from, to, normal);
    if (sides[k] < kContradicted) return false;
  }
  return (sides[0] > kSupported && sides[2] > kSupported) || (sides[1] > kSupported && sides[3] > kSupported);
}

// The nearest saddles of the other kind.
std::vector<std::size_t> oppositesOf(std::size_t seed, const std::vector<SaddleCandidate>& saddles) {
  constexpr double kMinStep_px = 4.0;
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t k = 0; k < saddles.size(); ++k) {
    const double distance_px = (saddles[k].at_px - saddles[seed].at_px).norm();
    if (k != seed && distance_px > kMinStep_px && isOpposite(saddles[seed], saddles[k]))
      near.emplace_back(distance_px, k);
  }
  const std::size_t taken = std::min(near.size(), kNeighbours);
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(taken), near.end());
  std::vector<std::size_t> indices;
  for (std::size_t k = 0; k < taken; ++k) indices.push_back(near[k].second);
  return indices;
}

std::optional<std::size_t> fourthCorner(const std::vector<SaddleCandidate>& saddles, std::size_t seed,
                                        std::size_t a, std::size_t b) {
  const Eigen::Vector2d side_a = saddles[a].at_px - saddles[seed].at_px,
                        side_b = saddles[b].at_px - saddles[seed].at_px,
                        place = saddles[seed].at_px + side_a + side_b;
  double best_px = kSeedTolerance * std::min(side_a.norm(), side_b.norm());
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < saddles.size(); ++k) {
    const double distance_px = (saddles[k].at_px - place).norm();
    if (k == seed || distance_px >= best_px || !isAlike(saddles[seed], saddles[k])) continue;
    best_px = distance_px;
    best = k;
  }
  return best;
}

}  // namespace

CornerLattice findCornerLattice(const std::vector<SaddleCandidate>& saddles,
                                const std::vector<MovedCrossing>& crossings, Resolution resolution_px,
                                const Board& board, const GridOptions& options) {
  const GradientPicture picture(crossings, resolution_px);
  LatticeGrowth growth(saddles, board, options);
  CornerLattice best;
  std::vector<bool> settled(saddles.size(), false);
  const bool tags = board.type == BoardType::AprilGrid;
  std::size_t seeds = 0;
  for (std::size_t seed = 0; seed < saddles.size() && seeds < kMaxSeeds; ++seed) {
    if (settled[seed]) continue;
    ++seeds;
    const std::vector<std::size_t> near = oppositesOf(seed, saddles);
    for (const std::size_t a : near) {
      for (const std::size_t b : near) {
        const Eigen::Vector2d side_a = saddles[a].at_px - saddles[seed].at_px,
                              side_b = saddles[b].at_px - saddles[seed].at_px;
        const double ratio = side_a.norm() / side_b.norm();
        if (crossProduct(side_a, side_b) < options.min_sine * side_a.norm() * side_b.norm()) continue;
        if (ratio > kMaxSideRatio || ratio < 1.0 / kMaxSideRatio) continue;
        const std::optional<std::size_t> c = fourthCorner(saddles, seed, a, b);
        if (!c) continue;
        const bool dark = isDarkBetween(saddles[seed], side_a, side_b);
        // A dark square of an AprilGrid: a tag, whose corners are dark inside, or one of the small squares.
        if (tags && !dark) continue;
        if (!hasSides({saddles[seed].at_px, saddles[a].at_px, saddles[*c].at_px, saddles[b].at_px}, dark,
                      picture))
          continue;
        for (int first_line = 0; first_line <= (tags ? 1 : 0); ++first_line) {
          std::vector<CornerNode> nodes = growth.from({seed, a, *c, b}, first_line);
          if (nodes.size() <= best.nodes.size()) continue;
          best = {std::move(nodes), dark};
        }
      }
    }
    if (best.nodes.size() >= static_cast<std::size_t>(options.min_circles))
      for (const CornerNode& node : best.nodes) settled[node.saddle] = true;
  }
  if (best.nodes.size() < static_cast<std::size_t>(options.min_circles)) return {};
  return best;
}

namespace {

// Corners of the board by their lines.
struct CornerGrid {
  int columns = 0, rows = 0;

  explicit CornerGrid(const Board& board)
      : columns(board.type == BoardType::AprilGrid ? 2 * board.cols : board.pointsInRow()),
        rows(board.type == BoardType::AprilGrid ? 2 * board.rows : board.pointCount() / board.pointsInRow()) {
  }

  static int pointAt(const Board& board, int i, int j) {
    if (board.type != BoardType::AprilGrid) return board.index(j, i);
    // Kalibr's order: tags from the bottom left, corners counterclockwise from the bottom left.
    const int tag = (board.rows - 1 - j / 2) * board.cols + i / 2;
    const int corner = j % 2 == 1 ? i % 2 : 3 - i % 2;
    return 4 * tag + corner;
  }
};

// The corners of one placement of the lattice on the board: a turn and a shift, which keep kinds of corners.
struct Laying {
  std::vector<std::pair<int, std::size_t>> points;  // point of the board, saddle
};

std::vector<Laying> layingsOf(const CornerLattice& lattice, const Board& board) {
  const CornerGrid grid(board);
  const bool tags = board.type == BoardType::AprilGrid;
  std::vector<Laying> layings;
  for (std::size_t turn = 0; turn < kLatticeTurns.size(); ++turn) {
    std::vector<LatticePlace> places;
    LatticePlace least{1 << 20, 1 << 20}, most{-(1 << 20), -(1 << 20)};
    for (const CornerNode& node : lattice.nodes) {
      const LatticePlace at = applied(kLatticeTurns[turn], {node.i, node.j});
      places.push_back(at);
      least = {std::min(least.first, at.first), std::min(least.second, at.second)};
      most = {std::max(most.first, at.first), std::max(most.second, at.second)};
    }
    // A quarter turn exchanges the kinds of corners.
    const bool dark_ahead = lattice.dark_ahead != (turn % 2 == 1);
    for (int dj = -most.second; dj < grid.rows - least.second; ++dj) {
      for (int di = -most.first; di < grid.columns - least.first; ++di) {
        // Node (0, 0) comes to (di, dj), and corners with even sums are dark ahead.
        if (((di + dj) % 2 == 0) != dark_ahead) continue;
        // The lines that begin a tag stay its beginning, unless the turn makes them its end.
        const bool ends_i = kLatticeTurns[turn][0] + kLatticeTurns[turn][1] < 0,
                   ends_j = kLatticeTurns[turn][2] + kLatticeTurns[turn][3] < 0;
        if (tags && ((di % 2 != 0) != ends_i || (dj % 2 != 0) != ends_j)) continue;
        Laying laying;
        for (std::size_t k = 0; k < places.size(); ++k) {
          const int i = places[k].first + di, j = places[k].second + dj;
          if (i < 0 || j < 0 || i >= grid.columns || j >= grid.rows) continue;
          laying.points.emplace_back(CornerGrid::pointAt(board, i, j), lattice.nodes[k].saddle);
        }
        layings.push_back(std::move(laying));
      }
    }
  }
  std::stable_sort(layings.begin(), layings.end(),
                   [](const Laying& a, const Laying& b) { return a.points.size() > b.points.size(); });
  return layings;
}

}  // namespace

// Errors are relative to the speed.
PlaneFlow flowOf(const std::vector<MovedCrossing>& crossings, const BoardScene& scene,
                 const ImageFrame& frame) {
  constexpr int kRounds = 6;
  PlaneFlow flow = PlaneFlow::Zero();
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix<double, 8, 8> matrix = Eigen::Matrix<double, 8, 8>::Zero();
    PlaneFlow vector = PlaneFlow::Zero();
    matrix.diagonal() << 1e-3, 1.0, 1.0, 1e-3, 1.0, 1.0, 20.0, 20.0;
    for (const MovedCrossing& crossing : crossings) {
      Eigen::Vector2d at = crossing.at_px.cast<double>(), velocity = crossing.velocity_px_s.cast<double>();
      const double speed = velocity.norm();
      Eigen::Vector2d row = velocity / speed;
      if (scene.camera) {
        const std::optional<Eigen::Vector2d> ideal = idealPixel(*scene.camera, at);
        if (!ideal) continue;
        at = *ideal;
        row = idealPixelScale(*scene.camera, at).transpose().inverse() * row;
      }
      if ((at - frame.centre_px).cwiseAbs().maxCoeff() > frame.scale_px) continue;
      const PlaneFlow a = frame.basis(at).transpose() * row;
      const double error = speed - a.dot(flow), scale = 0.25 * speed;
      const double w = (round == 0 ? 1.0 : cauchyWeight(error * error / (scale * scale))) / (speed * speed);
      matrix += w * a * a.transpose();
      vector += w * speed * a;
    }
    flow = matrix.ldlt().solve(vector);
  }
  return flow;
}

std::vector<BoardPlacement> placeOnBoard(const CornerLattice& lattice,
                                         const std::vector<SaddleCandidate>& saddles,
                                         const FlowWithin& flow_within, const BoardScene& scene,
                                         std::int64_t time_ns, const GridOptions& options) {
  constexpr double kNearlyBest = 0.8;
  std::vector<MovingPoint> ideal;
  for (const SaddleCandidate& saddle : saddles) {
    Eigen::Vector2d at = saddle.at_px;
    if (scene.camera) at = idealPixel(*scene.camera, at).value_or(Eigen::Vector2d::Constant(NAN));
    ideal.push_back({at, Eigen::Vector2d::Zero()});
  }
  std::vector<BoardPlacement> placements;
  std::optional<PlaneFlow> flow;
  ImageFrame frame;
  for (Laying& laying : layingsOf(lattice, scene.board)) {
    if (!placements.empty() && (placements.size() >= kMaxPlacements ||
                                static_cast<double>(laying.points.size()) <
                                    kNearlyBest * static_cast<double>(placements[0].circles.size())))
      break;
    std::erase_if(laying.points,
                  [&](const auto& point) { return !ideal[point.second].centre_px.allFinite(); });
    std::optional<Eigen::Matrix3d> h = fitAgreeing(laying.points, ideal, scene.board, options);
    if (!h || (scene.camera && !looksSquare(*h, *scene.camera))) continue;
    if (!flow) {
      Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
      for (const auto& [point, saddle] : laying.points) {
        low = low.cwiseMin(ideal[saddle].centre_px);
        high = high.cwiseMax(ideal[saddle].centre_px);
      }
      frame = {0.5 * (low + high), std::max(0.5 * (high - low).norm(), 1.0)};
      flow = flow_within(frame);
    }
    BoardPlacement& placement = placements.emplace_back();
    placement.circles = std::move(laying.points);
    placement.motion.time_ns = time_ns;
    placement.motion.ideal_from_board = *h;
    placement.motion.frame = frame;
    placement.motion.velocity_px_s = *flow;
  }
  return placements;
}

}  // namespace evical
