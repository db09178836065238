#include "core/frontend/pattern_agreement.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace evical {
namespace {

constexpr double kTolerance_px = 1.2;  // of a crossing's distance from its edge
constexpr double kMinCosine = 0.5;     // between the motion and the normal of an edge that fires

// A crossing on the board: its place, and the directions of the paper that its polarity allows, as
// counted in EdgeMap; -1: the motion is along such edges.
struct BoardCrossing {
  Eigen::Vector2d at_m;
  double tolerance_m;
  int along_x, along_y;
};

std::vector<BoardCrossing> crossingsOnBoard(const BoardMotion& motion, const BurstWindow& window,
                                            const EdgeMap& map, double half_window_s) {
  const Eigen::Matrix3d board_from_ideal = motion.ideal_from_board.inverse();
  std::vector<BoardCrossing> crossings;
  for (const WindowBurst& burst : window.bursts()) {
    const double time_s = static_cast<double>(burst.time_s);
    if (std::abs(time_s) > half_window_s) continue;
    const Eigen::Vector2d pixel(burst.ideal_x_px, burst.ideal_y_px);
    if (!pixel.allFinite()) continue;
    const Eigen::Vector2d velocity = motion.velocityAt(pixel) + time_s * motion.accelerationAt(pixel);
    const Eigen::Vector2d at_middle = pixel - motion.travel(pixel, time_s);
    const Eigen::Vector3d on_board = board_from_ideal * at_middle.homogeneous();
    const Eigen::Vector2d at_m = on_board.hnormalized();
    if (!map.contains(at_m)) continue;
    const Eigen::Matrix2d m_per_px =
        (board_from_ideal.topLeftCorner<2, 2>() - at_m * board_from_ideal.block<1, 2>(2, 0)) / on_board.z();
    // Cosine between the motion and the normals of edges, which are the rows of the inverse map.
    const Eigen::Vector2d speed_m_s = m_per_px * velocity;
    const Eigen::Vector2d cosine =
        speed_m_s.cwiseQuotient(m_per_px.rowwise().norm()) / (velocity.norm() + 1e-9);
    const auto directionOf = [&](double along, int positive) {
      if (std::abs(along) < kMinCosine) return -1;
      return along * static_cast<double>(burst.lead) > 0.0 ? positive : positive + 1;
    };
    crossings.push_back({at_m, kTolerance_px * std::sqrt(std::abs(m_per_px.determinant())),
                         directionOf(cosine.x(), EdgeMap::kPlusX), directionOf(cosine.y(), EdgeMap::kPlusY)});
  }
  return crossings;
}

// The direction of the paper, turned from the present placement to a rival's.
std::array<int, 4> turnedDirections(const Eigen::Matrix2d& rival_from_laid) {
  std::array<int, 4> turned = {};
  for (std::size_t k = 0; k < turned.size(); ++k) {
    const double sign = k % 2 == 0 ? 1.0 : -1.0;
    const Eigen::Vector2d way =
        rival_from_laid * (sign * (k < 2 ? Eigen::Vector2d::UnitX() : Eigen::Vector2d::UnitY()));
    const bool along_x = std::abs(way.x()) > std::abs(way.y());
    turned[k] = (along_x ? EdgeMap::kPlusX : EdgeMap::kPlusY) + ((along_x ? way.x() : way.y()) < 0.0 ? 1 : 0);
  }
  return turned;
}

struct Agreement {
  int explained = 0, contradicted = 0;
};

Agreement agreementOf(const std::vector<BoardCrossing>& crossings, const Eigen::Matrix3d& shift,
                      const EdgeMap& map) {
  const Eigen::Matrix3d rival_from_laid = shift.inverse();
  const std::array<int, 4> turned = turnedDirections(rival_from_laid.topLeftCorner<2, 2>());
  Agreement agreement;
  for (const BoardCrossing& crossing : crossings) {
    const Eigen::Vector2d at_m = (rival_from_laid * crossing.at_m.homogeneous()).head<2>();
    bool explained = false, contradicted = false;
    for (const int direction : {crossing.along_x, crossing.along_y}) {
      if (direction < 0) continue;
      const int own = turned[static_cast<std::size_t>(direction)];
      explained = explained || map.distance_m(at_m, own) < crossing.tolerance_m;
      contradicted = contradicted || map.distance_m(at_m, own ^ 1) < crossing.tolerance_m;
    }
    agreement.explained += explained;
    agreement.contradicted += contradicted && !explained;
  }
  return agreement;
}

}  // namespace

PrintMatch matchPrint(const BoardMotion& laid, const std::vector<Eigen::Matrix3d>& shifts,
                      const BurstWindow& window, const BoardScene& scene, double half_window_s) {
  // Placements and prints other than the true ones contradict 2.5 % of the crossings or more, the true ones
  // 0.5 %.
  constexpr double kLargestContradiction = 0.015;
  const std::vector<BoardCrossing> crossings =
      crossingsOnBoard(laid, window, scene.edges->map, half_window_s);
  PrintMatch best;
  int best_value = -1;
  const auto consider = [&](const std::shared_ptr<const BoardEdges>& edges) {
    for (const Eigen::Matrix3d& shift : shifts) {
      const Agreement agreement = agreementOf(crossings, shift, edges->map);
      const int value = agreement.explained - agreement.contradicted;
      if (value <= best_value) continue;
      best_value = value;
      best = {
          edges, shift,
          agreement.contradicted <= kLargestContradiction * (agreement.explained + agreement.contradicted)};
    }
  };
  consider(scene.edges);
  if (best.matches || scene.print_known) return best;
  for (const TagPrint& print : possiblePrints(scene.board))
    if (const auto edges = edgesOf(scene.board, print); edges != scene.edges) consider(edges);
  return best;
}

std::vector<PlacementScore> rivalPatterns(const BoardMotion& laid, const std::vector<Eigen::Matrix3d>& shifts,
                                          const BurstWindow& window, const BoardScene& scene,
                                          double half_window_s, const TrackingOptions& options) {
  const EdgeMap& map = scene.edges->map;
  const std::vector<BoardCrossing> crossings = crossingsOnBoard(laid, window, map, half_window_s);
  const auto points =
      static_cast<double>(std::max(expectedCircles(laid, scene, half_window_s), options.min_circle_bursts));
  const double per_point = std::max(static_cast<double>(crossings.size()) / points, 1.0);
  std::vector<PlacementScore> rivals;
  for (const Eigen::Matrix3d& shift : shifts) {
    const Agreement agreement = agreementOf(crossings, shift, map);
    PlacementScore& rival = rivals.emplace_back();
    rival.shift = shift;
    rival.measured = static_cast<int>(std::lround(agreement.explained / per_point));
    rival.missing = static_cast<int>(std::lround(agreement.contradicted / per_point));
  }
  std::stable_sort(rivals.begin(), rivals.end(),
                   [](const PlacementScore& a, const PlacementScore& b) { return a.value() > b.value(); });
  return rivals;
}

namespace {

// A rotation by quarter turns; then the lowest corner of the turned board is at the origin.
Eigen::Matrix3d turnOf(int quarter_turns, const Eigen::Vector2d& extent_m) {
  constexpr std::array<std::array<double, 2>, 4> kCosineSine = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  const auto& [c, s] = kCosineSine[static_cast<std::size_t>(quarter_turns)];
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() << c, -s, s, c;
  const Eigen::Vector2d far = turn.topLeftCorner<2, 2>() * extent_m;
  turn.topRightCorner<2, 1>() = -far.cwiseMin(0.0);
  return turn;
}

bool leavesUnchanged(const Eigen::Matrix3d& shift, const Board& board, const PrintedPattern& pattern) {
  constexpr int kSteps = 8;  // in a spacing
  const double step_m = board.spacing_m / kSteps;
  const Eigen::Vector2d low = Eigen::Vector2d::Constant(-board.printBeyond_m()),
                        high = board.extent_m() - low;
  for (double y = low.y() + 0.37 * step_m; y < high.y(); y += step_m)
    for (double x = low.x() + 0.37 * step_m; x < high.x(); x += step_m) {
      const Eigen::Vector2d at(x, y);
      if (pattern.isInk(at) != pattern.isInk((shift * at.homogeneous()).head<2>())) return false;
    }
  return true;
}

}  // namespace

std::vector<Eigen::Matrix3d> patternShifts(const Board& board, const BoardEdges& edges, double min_overlap) {
  const bool tags = board.type == BoardType::AprilGrid;
  const int columns = board.pointsInRow(), rows = tags ? board.rows : board.pointCount() / columns;
  std::vector<Eigen::Matrix3d> shifts = {Eigen::Matrix3d::Identity()};
  for (int turn = 0; turn < 4; ++turn) {
    const int own_columns = turn % 2 == 0 ? columns : rows, own_rows = turn % 2 == 0 ? rows : columns;
    const Eigen::Matrix3d turned = turnOf(turn, board.extent_m());
    for (int dj = -own_rows + 1; dj < rows; ++dj) {
      for (int di = -own_columns + 1; di < columns; ++di) {
        const int shared_columns = std::min(columns, di + own_columns) - std::max(0, di),
                  shared_rows = std::min(rows, dj + own_rows) - std::max(0, dj);
        if (shared_columns * shared_rows < min_overlap * columns * rows) continue;
        Eigen::Matrix3d shift = turned;
        shift.topRightCorner<2, 1>() += board.spacing_m * Eigen::Vector2d(di, dj);
        if (!leavesUnchanged(shift, board, edges.pattern)) shifts.push_back(shift);
      }
    }
  }
  return shifts;
}

}  // namespace evical
