#include "core/frontend/pattern_agreement.h"

#include "core/frontend/tag_reading.h"

#include "core/geometry/camera_model.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace evical {
namespace {

constexpr double kTolerance_px = 1.2;  // of a crossing's distance from its edge
constexpr double kMinCosine = 0.5;     // between the motion and the normal of an edge that fires

std::vector<BoardCrossing> crossingsOnBoard(const BoardMotion& motion, const BurstWindow& window,
                                            const EdgeMap& map, double half_window_s, double beyond) {
  constexpr double kRoughly = 0.1;  // of the board's size: farther than any burst moves in a window
  const Eigen::Matrix3d board_from_ideal = motion.ideal_from_board.inverse();
  std::vector<BoardCrossing> crossings;
  for (const WindowBurst& burst : window.bursts()) {
    const double time_s = static_cast<double>(burst.time_s);
    if (std::abs(time_s) > half_window_s) continue;
    const Eigen::Vector2d pixel(burst.ideal_x_px, burst.ideal_y_px);
    if (!pixel.allFinite()) continue;
    // Most bursts are elsewhere, and their motion is not needed.
    if (!map.isAround((board_from_ideal * pixel.homogeneous()).hnormalized(), beyond + kRoughly)) continue;
    const Eigen::Vector2d velocity = motion.velocityAt(pixel) + time_s * motion.accelerationAt(pixel);
    const Eigen::Vector2d at_middle = pixel - motion.travel(pixel, time_s);
    const Eigen::Vector3d on_board = board_from_ideal * at_middle.homogeneous();
    const Eigen::Vector2d at_m = on_board.hnormalized();
    if (!map.isAround(at_m, beyond)) continue;
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

// A part of the crossings is enough where placements are many or each window is looked at.
void thinOut(std::vector<BoardCrossing>& crossings) {
  constexpr std::size_t kEnough = 2000;
  const std::size_t step = crossings.size() / kEnough;
  if (step < 2) return;
  std::size_t count = 0;
  for (std::size_t k = 0; k < crossings.size(); k += step) crossings[count++] = crossings[k];
  crossings.resize(count);
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

  int value() const { return explained - contradicted; }
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

// The edges of the lattice of a checkerboard, far around its present placement: those that should cause
// events, and those that do. Each edge is looked at once, and each rival counts its own ones.
class LatticeEdges {
 public:
  LatticeEdges(const BoardMotion& laid, const std::vector<BoardCrossing>& crossings, const BoardScene& scene,
               double half_window_s)
      : spacing_m_(scene.board.spacing_m),
        columns_(3 * (scene.board.cols + kBorder)),
        rows_(3 * (scene.board.rows + kBorder)),
        first_column_(-columns_ / 3),
        first_row_(-rows_ / 3),
        edges_(static_cast<std::size_t>(2 * columns_ * rows_)) {
    for (const BoardCrossing& crossing : crossings) {
      mark(crossing, true, crossing.along_x);
      mark(crossing, false, crossing.along_y);
    }
    for (int row = 0; row < rows_; ++row)
      for (int column = 0; column < columns_; ++column)
        for (const bool vertical : {true, false})
          edges_[indexOf(column, row, vertical)].expected =
              isExpected(laid, scene, spacing_m_ * Eigen::Vector2d(column + first_column_, row + first_row_),
                         vertical ? Eigen::Vector2d::UnitY() : Eigen::Vector2d::UnitX(), half_window_s);
  }

  struct Count {
    int expected = 0, seen = 0, opposite = 0;  // with events; with events of the opposite edge
  };
  Count countOf(const std::vector<PrintedEdge>& own, const Eigen::Matrix3d& shift) const {
    Count count;
    for (const PrintedEdge& edge : own) {
      const Eigen::Vector2d middle =
          (shift * (0.5 * (edge.from_m + edge.to_m)).homogeneous()).head<2>() / spacing_m_;
      const Eigen::Vector2d paper = shift.topLeftCorner<2, 2>() * edge.paper;
      const bool vertical = std::abs(paper.x()) > std::abs(paper.y());
      const std::optional<std::size_t> index = edgeAt(middle, vertical);
      if (!index || !edges_[*index].expected) continue;
      const Edge& at = edges_[*index];
      const std::size_t minus = paper.sum() < 0.0 ? 1 : 0;
      ++count.expected;
      count.seen += at.seen[minus];
      count.opposite += at.seen[1 - minus];
    }
    return count;
  }

 private:
  static constexpr int kBorder = 2;  // squares beyond the corners

  struct Edge {
    bool expected = false;
    std::array<bool, 2> seen = {};  // paper in the positive and the negative direction
  };

  std::size_t indexOf(int column, int row, bool vertical) const {
    return static_cast<std::size_t>((row * columns_ + column) * 2 + (vertical ? 1 : 0));
  }

  // `place` in squares.
  std::optional<std::size_t> edgeAt(const Eigen::Vector2d& place, bool vertical) const {
    const auto whole = [](double at, bool line) {
      return static_cast<int>(line ? std::round(at) : std::floor(at));
    };
    const int column = whole(place.x(), vertical) - first_column_,
              row = whole(place.y(), !vertical) - first_row_;
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return std::nullopt;
    return indexOf(column, row, vertical);
  }

  void mark(const BoardCrossing& crossing, bool vertical, int direction) {
    constexpr double kEnds = 0.1;  // of an edge: crossings there may be of the next one
    if (direction < 0) return;
    const Eigen::Vector2d place = crossing.at_m / spacing_m_;
    const double across = vertical ? place.x() : place.y(), along = vertical ? place.y() : place.x();
    if (std::abs(across - std::round(across)) * spacing_m_ > crossing.tolerance_m) return;
    if (std::abs(along - std::floor(along) - 0.5) > 0.5 - kEnds) return;
    if (const std::optional<std::size_t> edge = edgeAt(place, vertical))
      edges_[*edge].seen[static_cast<std::size_t>(direction & 1)] = true;
  }

  static bool isExpected(const BoardMotion& laid, const BoardScene& scene, const Eigen::Vector2d& from_m,
                         const Eigen::Vector2d& along, double half_window_s) {
    constexpr double kMinTravel_px = 1.2, kMargin_px = 2.0;
    const auto imageOf = [&](double part) {
      return Eigen::Vector3d(laid.ideal_from_board *
                             (from_m + part * scene.board.spacing_m * along).homogeneous());
    };
    const Eigen::Vector3d middle = imageOf(0.5), begin = imageOf(0.0), end = imageOf(1.0);
    if (!(middle.z() > 0.0) || !(begin.z() > 0.0) || !(end.z() > 0.0)) return false;
    const Eigen::Vector2d ideal = middle.hnormalized(),
                          normal = (end.hnormalized() - begin.hnormalized()).unitOrthogonal(),
                          velocity = laid.velocityAt(ideal);
    const double across = std::abs(normal.dot(velocity));
    if (across < kMinCosine * velocity.norm() || 2.0 * half_window_s * across < kMinTravel_px) return false;
    const Eigen::Vector2d at = scene.camera ? pixelFromIdeal(*scene.camera, ideal) : ideal;
    return at.x() > kMargin_px && at.y() > kMargin_px &&
           at.x() < scene.resolution_px.width_px - 1 - kMargin_px &&
           at.y() < scene.resolution_px.height_px - 1 - kMargin_px;
  }

  double spacing_m_;
  int columns_, rows_, first_column_, first_row_;
  std::vector<Edge> edges_;
};

// Weight of an edge without events against a placement, relative to that of one with events for it: the ratio
// of the logarithms of their probabilities on and off the board.
double weightOfAbsence(const LatticeEdges::Count& laid) {
  const double expected = std::max(laid.expected, 1);
  const double on_board = std::clamp(laid.seen / expected, 0.3, 0.97),
               beside = std::clamp(laid.opposite / expected, 0.05, 0.5 * on_board);
  return std::log((1.0 - beside) / (1.0 - on_board)) / std::log(on_board / beside);
}

}  // namespace

namespace {

// Cosines between the motion of the board's middle and the normals of its edges across x and across y.
Eigen::Array2d cosinesAcross(const BoardMotion& motion, const Board& board) {
  const Eigen::Vector2d middle_m = board.corner_m() + 0.5 * board.extent_m();
  const Eigen::Vector3d image = motion.ideal_from_board * middle_m.homogeneous();
  const Eigen::Vector2d at = image.hnormalized(), velocity = motion.velocityAt(at);
  const Eigen::Matrix2d px_per_m =
      (motion.ideal_from_board.topLeftCorner<2, 2>() - at * motion.ideal_from_board.block<1, 2>(2, 0)) /
      image.z();
  const Eigen::Matrix2d normals = px_per_m.inverse();  // its rows
  return (normals * velocity).array().abs() / normals.rowwise().norm().array() / (velocity.norm() + 1e-9);
}

}  // namespace

SlideCheck checkSlide(const BoardMotion& laid, const BurstWindow& window, const BoardScene& scene,
                      double half_window_s) {
  constexpr double kAgrees = 0.005,
                   kContradicts = 0.1;  // contradicting crossings of the true placement
  constexpr int kFarthest_px = 6;
  constexpr double kLeast_px = 0.25;
  std::vector<BoardCrossing> crossings = crossingsOnBoard(laid, window, scene.edges->map, half_window_s, 0.0);
  if (crossings.empty()) return {};
  thinOut(crossings);
  const double m_per_px = crossings.front().tolerance_m / kTolerance_px;
  const auto movedBy = [&](const Eigen::Vector2d& px) {
    Eigen::Matrix3d shift = Eigen::Matrix3d::Identity();
    shift.topRightCorner<2, 1>() = m_per_px * px;
    return shift;
  };
  const auto at = [&](const Eigen::Vector2d& px) {
    return agreementOf(crossings, movedBy(px), scene.edges->map);
  };
  Agreement best = at(Eigen::Vector2d::Zero());
  const auto contradictedShare = [](const Agreement& of) {
    return of.contradicted / std::max(1.0, static_cast<double>(of.explained + of.contradicted));
  };
  if (contradictedShare(best) <= kAgrees) return {};
  Eigen::Vector2d place_px = Eigen::Vector2d::Zero(), part_px = place_px;
  const Eigen::Array2d cosines = cosinesAcross(laid, scene.board);
  for (const Eigen::Index k : {1, 0}) {
    if (cosines[k] > kMinCosine) continue;  // edges across hold the board
    const Eigen::Vector2d axis = Eigen::Vector2d::Unit(k);
    std::array<Agreement, 2> beside;  // before and after
    for (int step = 0; step < kFarthest_px; ++step) {
      beside = {at(place_px - axis), at(place_px + axis)};
      const std::size_t better = beside[1].value() > beside[0].value() ? 1 : 0;
      if (beside[better].value() <= best.value()) break;
      best = beside[better];
      place_px += better == 1 ? axis : Eigen::Vector2d(-axis);
    }
    // Agreement decreases about linearly on both sides.
    const double fall = best.value() - std::min(beside[0].value(), beside[1].value());
    if (fall > 0.0) part_px += 0.5 * (beside[1].value() - beside[0].value()) / fall * axis;
  }
  SlideCheck check;
  place_px += part_px;
  if (place_px.norm() > kLeast_px) check.moved = shifted(laid, movedBy(place_px));
  check.contradicted = contradictedShare(best) > kContradicts;
  return check;
}

PrintMatch matchPrint(const BoardMotion& laid, const std::vector<Eigen::Matrix3d>& shifts,
                      const BurstWindow& window, const BoardScene& scene, double half_window_s) {
  // Placements and prints other than the true ones contradict 2.5 % of the crossings or more, the true ones
  // 0.5 %.
  constexpr double kLargestContradiction = 0.015;
  const std::vector<BoardCrossing> crossings =
      crossingsOnBoard(laid, window, scene.edges->map, half_window_s, 0.0);
  PrintMatch best;
  int best_value = -1;
  const auto consider = [&](const std::shared_ptr<const BoardEdges>& edges) {
    for (const Eigen::Matrix3d& shift : shifts) {
      const Agreement agreement = agreementOf(crossings, shift, edges->map);
      if (agreement.value() <= best_value) continue;
      best_value = agreement.value();
      best = {
          edges, shift,
          agreement.contradicted <= kLargestContradiction * (agreement.explained + agreement.contradicted)};
    }
  };
  consider(scene.edges);
  if (best.matches) return best;
  // Blurred edges contradict more often. Then the numbers decide.
  const std::optional<TagReading> reading = readTags(crossings, scene.board);
  if (!reading) return best;
  const std::shared_ptr<const BoardEdges> edges =
      reading->print == scene.edges->print ? scene.edges : edgesOf(scene.board, reading->print);
  if (scene.print_known && edges != scene.edges) return best;
  consider(edges);
  best.matches = best.matches || (best.edges == edges && reading->areOf(scene.board));
  if (!best.matches && scene.board.type == BoardType::AprilGrid)
    best.numbers = {reading->smallest, reading->largest};
  return best;
}

std::vector<PlacementScore> rivalPatterns(const BoardMotion& laid, const std::vector<Eigen::Matrix3d>& shifts,
                                          const BurstWindow& window, const BoardScene& scene,
                                          double half_window_s, const TrackingOptions& options) {
  // Around a checkerboard, rivals explain edges that it does not. Bits distinguish placements of tags better.
  const bool tags = scene.board.hasTags();
  const double beyond = tags ? 0.0 : 0.5;  // of the board's size
  const EdgeMap& map = scene.edges->map;
  std::vector<BoardCrossing> crossings = crossingsOnBoard(laid, window, map, half_window_s, beyond);
  if (tags) thinOut(crossings);
  const auto on_board = static_cast<double>(
      std::count_if(crossings.begin(), crossings.end(),
                    [&](const BoardCrossing& crossing) { return map.contains(crossing.at_m); }));
  const auto points =
      static_cast<double>(std::max(expectedCircles(laid, scene, half_window_s), options.min_circle_bursts));
  const double per_point = std::max(on_board / points, 1.0);
  std::optional<LatticeEdges> lattice;
  if (!tags) lattice.emplace(laid, crossings, scene, half_window_s);
  const std::vector<PrintedEdge>& edges = scene.edges->edges;
  LatticeEdges::Count own;
  if (lattice) own = lattice->countOf(edges, Eigen::Matrix3d::Identity());
  const double per_edge = weightOfAbsence(own) * points / std::max(own.expected, 1);
  std::vector<PlacementScore> rivals;
  for (const Eigen::Matrix3d& shift : shifts) {
    const Agreement agreement = agreementOf(crossings, shift, map);
    PlacementScore& rival = rivals.emplace_back();
    rival.shift = shift;
    rival.measured = agreement.explained / per_point;
    rival.missing = agreement.contradicted / per_point;
    if (!lattice) continue;
    const LatticeEdges::Count count = lattice->countOf(edges, shift);
    rival.absent = per_edge * (count.expected - count.seen);
  }
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
