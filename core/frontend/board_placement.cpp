#include "core/frontend/board_placement.h"

#include "core/frontend/board_motion.h"

#include "core/geometry/camera_model.h"
#include "core/geometry/homography.h"
#include "core/geometry/point_lattice.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace evical {

CircleLattice findCircleLattice(const std::vector<MovingCircle>& circles, const GridOptions& options) {
  std::vector<LatticeCircle> still;
  still.reserve(circles.size());
  for (const MovingCircle& circle : circles) still.push_back({circle.centre_px, circle.radius_px});
  const LatticeOptions lattice = {.min_step_radii = options.min_step_radii,
                                  .max_step_radii = options.max_step_radii,
                                  .max_radius_ratio = options.max_radius_ratio,
                                  .step_tolerance = options.step_tolerance,
                                  .min_sine = options.min_sine,
                                  .min_circles = options.min_circles};
  return findCircleLattice(still, lattice);
}

namespace {

// Placements with fewer circles than this share of the best one's are not fitted.
constexpr double kNearlyBest = 0.8;

// Tolerance of the board's axes for equal length (logarithm of the ratio) and perpendicularity (cosine).
constexpr double kAxesTolerance = 0.2;

MovingPoint toIdeal(const MovingCircle& circle, const std::optional<CameraIntrinsics>& camera) {
  if (!camera) return {circle.centre_px, circle.velocity_px_s};
  const std::optional<Eigen::Vector2d> ideal = idealPixel(*camera, circle.centre_px);
  if (!ideal) return {Eigen::Vector2d::Constant(NAN), Eigen::Vector2d::Zero()};
  return {*ideal, idealPixelScale(*camera, *ideal) * circle.velocity_px_s};
}

}  // namespace

bool looksSquare(const Eigen::Matrix3d& ideal_from_board, const CameraIntrinsics& camera) {
  Eigen::Matrix3d k = Eigen::Matrix3d::Identity();
  k.diagonal().head<2>() = idealFocalLength_px(camera);
  k.topRightCorner<2, 1>() = camera.principal_point_px;
  const Eigen::Matrix3d axes = k.inverse() * ideal_from_board;
  const double x = axes.col(0).norm(), y = axes.col(1).norm();
  return std::abs(std::log(x / y)) < kAxesTolerance &&
         std::abs(axes.col(0).dot(axes.col(1))) < kAxesTolerance * x * y;
}

std::optional<Eigen::Matrix3d> fitAgreeing(std::vector<std::pair<int, std::size_t>>& placed,
                                           const std::vector<MovingPoint>& ideal, const Board& board,
                                           const GridOptions& options) {
  for (;;) {
    if (static_cast<int>(placed.size()) < options.min_circles) return std::nullopt;
    std::vector<Eigen::Vector2d> from, to;
    for (const auto& [circle, index] : placed) {
      from.push_back(board.point_m(circle));
      to.push_back(ideal[index].centre_px);
    }
    const std::optional<Eigen::Matrix3d> h = fitHomography(from, to);
    if (!h) return std::nullopt;
    std::size_t worst = placed.size();
    double worst_error = options.step_tolerance;
    for (std::size_t k = 0; k < placed.size(); ++k) {
      const Eigen::Vector2d predicted_px = ((*h) * from[k].homogeneous()).hnormalized();
      const Eigen::Vector2d beside_px =
          ((*h) * (from[k] + Eigen::Vector2d(board.spacing_m, 0)).homogeneous()).hnormalized();
      const double error = (predicted_px - to[k]).norm() / (beside_px - predicted_px).norm();
      if (error > worst_error) {
        worst_error = error;
        worst = k;
      }
    }
    if (worst == placed.size()) return h;
    placed.erase(placed.begin() + static_cast<std::ptrdiff_t>(worst));
  }
}

namespace {

// The board's circle whose place is nearest, if the place is on the board.
std::optional<int> nearestCircle(const Board& board, const Eigen::Vector2d& place_m) {
  const bool asymmetric = board.type == BoardType::AsymmetricCircles;
  const Eigen::Vector2d place = place_m / board.spacing_m;
  if (!(place.cwiseAbs().maxCoeff() < 1e3)) return std::nullopt;  // nor NaN
  const auto row = static_cast<int>(std::lround(place.y()));
  const double x = asymmetric ? 0.5 * (place.x() - std::abs(row % 2)) : place.x();
  const auto col = static_cast<int>(std::lround(x));
  if (row < 0 || row >= board.rows || col < 0 || col >= board.cols) return std::nullopt;
  return board.index(row, col);
}

// Adds circles that the lattice missed or had assigned to an outlier: those near a place that the homography
// predicts. Looks from each circle to the board: a board that is given too large has many more places.
void fillGaps(const Eigen::Matrix3d& ideal_from_board, const std::vector<MovingPoint>& ideal,
              const Board& board, const GridOptions& options,
              std::vector<std::pair<int, std::size_t>>& placed) {
  const auto count = static_cast<std::size_t>(board.pointCount());
  std::vector<bool> found(count, false), used(ideal.size(), false);
  for (const auto& [circle, index] : placed) found[static_cast<std::size_t>(circle)] = used[index] = true;
  const Eigen::Matrix3d board_from_ideal = ideal_from_board.inverse();
  const auto imageOf = [&](const Eigen::Vector2d& on_board) {
    return Eigen::Vector2d((ideal_from_board * on_board.homogeneous()).hnormalized());
  };
  std::map<int, std::pair<double, std::size_t>> nearest;  // by circle: distance, index
  for (std::size_t k = 0; k < ideal.size(); ++k) {
    if (used[k]) continue;
    const auto circle =
        nearestCircle(board, (board_from_ideal * ideal[k].centre_px.homogeneous()).hnormalized());
    if (!circle || found[static_cast<std::size_t>(*circle)]) continue;
    const Eigen::Vector2d centre = board.point_m(*circle), predicted_px = imageOf(centre);
    const double step_px = (imageOf(centre + Eigen::Vector2d(board.spacing_m, 0.0)) - predicted_px).norm();
    const double distance_px = (ideal[k].centre_px - predicted_px).norm();
    if (!(distance_px < 0.5 * options.step_tolerance * step_px)) continue;
    const auto [at, first] = nearest.try_emplace(*circle, distance_px, k);
    if (!first && distance_px < at->second.first) at->second = {distance_px, k};
  }
  for (const auto& [circle, found_at] : nearest) placed.emplace_back(circle, found_at.second);
}

}  // namespace

namespace {

// The first of all motions that map the lattice onto the same places: if the board is unchanged by a
// rotation, a rotated placement is not a rival.
std::vector<Eigen::Matrix3d> withoutTwins(const std::vector<Eigen::Matrix3d>& motions,
                                          const std::vector<Eigen::Matrix3d>& onto_itself) {
  constexpr double kSame = 1e-9;
  std::vector<Eigen::Matrix3d> distinct;
  for (const Eigen::Matrix3d& motion : motions) {
    const bool known = std::any_of(distinct.begin(), distinct.end(), [&](const Eigen::Matrix3d& other) {
      return std::any_of(onto_itself.begin(), onto_itself.end(),
                         [&](const Eigen::Matrix3d& turn) { return (motion - other * turn).norm() < kSame; });
    });
    if (!known) distinct.push_back(motion);
  }
  return distinct;
}

}  // namespace

std::vector<Eigen::Matrix3d> latticeShifts(const Board& board, double min_overlap) {
  const std::map<LatticePlace, int> lattice = boardLattice(board);
  Eigen::Matrix2d metres_per_step = board.spacing_m * Eigen::Matrix2d::Identity();
  if (board.type == BoardType::AsymmetricCircles)
    metres_per_step << board.spacing_m, board.spacing_m, -board.spacing_m, board.spacing_m;
  std::vector<Eigen::Matrix3d> shifts = {Eigen::Matrix3d::Identity()}, onto_itself = shifts;
  int reach = 0;  // of places from the origin: counts are in a table, since pairs of circles are many
  for (const auto& [place, circle] : lattice)
    reach = std::max({reach, std::abs(place.first), std::abs(place.second)});
  const int side = 4 * reach + 1;
  for (const LatticeMap& turn : kLatticeTurns) {
    std::vector<int> counts(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0);
    for (const auto& [from, circle] : lattice) {
      const LatticePlace at = applied(turn, from);
      for (const auto& [to, other] : lattice)
        ++counts[static_cast<std::size_t>((to.first - at.first + 2 * reach) * side + to.second - at.second +
                                          2 * reach)];
    }
    for (std::size_t k = 0; k < counts.size(); ++k) {
      const int count = counts[k], at = static_cast<int>(k);
      const LatticePlace shift{at / side - 2 * reach, at % side - 2 * reach};
      if (count == 0 || count < min_overlap * board.pointCount()) continue;
      if (turn == kLatticeTurns.front() && shift == LatticePlace{0, 0}) continue;
      Eigen::Matrix2d turned;
      turned << turn[0], turn[1], turn[2], turn[3];
      Eigen::Matrix3d motion = Eigen::Matrix3d::Identity();
      motion.topLeftCorner<2, 2>() = metres_per_step * turned * metres_per_step.inverse();
      motion.topRightCorner<2, 1>() = metres_per_step * Eigen::Vector2d(shift.first, shift.second);
      shifts.push_back(motion);
      if (count == board.pointCount()) onto_itself.push_back(motion);
    }
  }
  return withoutTwins(shifts, onto_itself);
}

std::vector<BoardPlacement> placeOnBoard(const CircleLattice& lattice,
                                         const std::vector<MovingCircle>& circles, const BoardScene& scene,
                                         std::int64_t time_ns, const GridOptions& options) {
  std::vector<BoardPlacement> placements;
  std::vector<MovingPoint> ideal;
  for (const MovingCircle& circle : circles) ideal.push_back(toIdeal(circle, scene.camera));
  // All shifts of one map have the same axes: if its first placement is not square, none is.
  std::set<LatticeMap> sheared;
  for (LatticePlacement& laid : layOnBoard(lattice, scene.board, kNearlyBest)) {
    if (scene.camera && placements.size() == kMaxPlacements) break;
    if (sheared.contains(laid.map)) continue;
    BoardPlacement placement;
    placement.circles = std::move(laid.circles);
    std::erase_if(placement.circles,
                  [&](const auto& circle) { return !ideal[circle.second].centre_px.allFinite(); });
    std::optional<Eigen::Matrix3d> h = fitAgreeing(placement.circles, ideal, scene.board, options);
    if (h) {
      fillGaps(*h, ideal, scene.board, options, placement.circles);
      h = fitAgreeing(placement.circles, ideal, scene.board, options);
    }
    if (!h) continue;
    if (scene.camera && !looksSquare(*h, *scene.camera)) {
      sheared.insert(laid.map);
      continue;
    }
    std::vector<MovingPoint> placed;
    for (const auto& [circle, index] : placement.circles) placed.push_back(ideal[index]);
    placement.motion = motionFromPoints(*h, placed, time_ns);
    placements.push_back(std::move(placement));
  }
  std::stable_sort(
      placements.begin(), placements.end(),
      [](const BoardPlacement& a, const BoardPlacement& b) { return a.circles.size() > b.circles.size(); });
  return placements;
}

}  // namespace evical
