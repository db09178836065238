#include "core/frontend/rival_placements.h"

#include "core/frontend/board_placement.h"
#include "core/frontend/circle_measurement.h"
#include "core/frontend/pattern_agreement.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace evical {
namespace {

// The lattice around the board's present placement, extended to all rivals. Each place is measured once, and
// each rival sums its own places.
class LatticeAround {
 public:
  LatticeAround(const BoardMotion& laid, const std::vector<Eigen::Matrix3d>& shifts, const BoardScene& scene)
      : scene_(scene), motion_(laid) {
    const Board& board = scene.board;
    Eigen::Vector2d least = Eigen::Vector2d::Zero(), most = Eigen::Vector2d::Zero();  // in spacings
    for (const Eigen::Matrix3d& shift : shifts) {
      for (int circle = 0; circle < board.pointCount(); ++circle) {
        const Eigen::Vector2d place = placeOf(shift, circle);
        least = least.cwiseMin(place);
        most = most.cwiseMax(place);
      }
    }
    // Extended by an even number of rows, so that the stagger of rows is unchanged.
    rows_before_ = 2 * static_cast<int>(std::ceil(-0.5 * least.y() - kSlack));
    columns_before_ = static_cast<int>(std::ceil(-least.x() / columnStep() - kSlack));
    scene_.board.rows = rows_before_ + static_cast<int>(std::ceil(most.y() - kSlack)) + 1;
    scene_.board.cols = columns_before_ + static_cast<int>(std::ceil(most.x() / columnStep() - kSlack)) + 1;
    Eigen::Matrix3d origin = Eigen::Matrix3d::Identity();
    origin.topRightCorner<2, 1>() =
        -board.spacing_m * Eigen::Vector2d(columns_before_ * columnStep(), rows_before_);
    motion_ = shifted(laid, origin);
  }

  void look(const BurstWindow& window, double half_window_s, const TrackingOptions& options) {
    const auto count = static_cast<std::size_t>(scene_.board.pointCount());
    measured_.assign(count, 0);
    expected_.assign(count, 0);
    for (const CircleObservation& circle : measureCircles(window, motion_, scene_, {half_window_s}, options))
      measured_[static_cast<std::size_t>(circle.circle)] = 1;
    for (const int circle : circlesExpected(motion_, scene_, half_window_s))
      expected_[static_cast<std::size_t>(circle)] = 1;
  }

  // Score of the board with this number of circles and this shift.
  PlacementScore score(const Eigen::Matrix3d& shift, int circle_count) const {
    PlacementScore score;
    score.shift = shift;
    int expected = 0;
    for (int circle = 0; circle < circle_count; ++circle) {
      const auto at = static_cast<std::size_t>(indexOf(placeOf(shift, circle)));
      score.measured += measured_[at];
      expected += expected_[at];
    }
    score.missing = std::max(expected - score.measured, 0.0);
    return score;
  }

 private:
  static constexpr double kSlack = 1e-6;

  double columnStep() const { return scene_.board.type == BoardType::AsymmetricCircles ? 2.0 : 1.0; }

  // Place in spacings, relative to the first circle of the present placement.
  Eigen::Vector2d placeOf(const Eigen::Matrix3d& shift, int circle) const {
    return (shift * board_.point_m(circle).homogeneous()).hnormalized() / board_.spacing_m;
  }
  int indexOf(const Eigen::Vector2d& place) const {
    const int row = static_cast<int>(std::lround(place.y())) + rows_before_;
    const bool out_of_step = scene_.board.type == BoardType::AsymmetricCircles && row % 2 != 0;
    const double column = (place.x() - (out_of_step ? 1.0 : 0.0)) / columnStep();
    return scene_.board.index(row, static_cast<int>(std::lround(column)) + columns_before_);
  }

  BoardScene scene_;
  Board board_ = scene_.board;  // without the surrounding lattice
  BoardMotion motion_;
  int rows_before_ = 0, columns_before_ = 0;
  std::vector<std::uint8_t> measured_, expected_;  // by circle of the surrounding lattice
};

}  // namespace

std::vector<PlacementScore> rivalPlacements(const BoardMotion& laid,
                                            const std::vector<Eigen::Matrix3d>& shifts,
                                            const BurstWindow& window, const BoardScene& scene,
                                            double half_window_s, const TrackingOptions& options) {
  if (scene.edges) return rivalPatterns(laid, shifts, window, scene, half_window_s, options);
  LatticeAround lattice(laid, shifts, scene);
  lattice.look(window, half_window_s, options);
  std::vector<PlacementScore> rivals;
  for (const Eigen::Matrix3d& shift : shifts)
    rivals.push_back(lattice.score(shift, scene.board.pointCount()));
  return rivals;
}

void sortByValue(std::vector<PlacementScore>& rivals) {
  std::stable_sort(rivals.begin(), rivals.end(),
                   [](const PlacementScore& a, const PlacementScore& b) { return a.value() > b.value(); });
}

BoardMotion shifted(const BoardMotion& motion, const Eigen::Matrix3d& shift) {
  BoardMotion moved = motion;
  moved.ideal_from_board = motion.ideal_from_board * shift;
  moved.ideal_from_board /= moved.ideal_from_board(2, 2);
  return moved;
}

std::vector<int> renumbering(const Board& board, const Eigen::Matrix3d& shift) {
  constexpr double kSamePlace = 1e-3;  // of the spacing
  std::vector<int> rival_of(static_cast<std::size_t>(board.pointCount()), -1);
  for (int rival = 0; rival < board.pointCount(); ++rival) {
    const Eigen::Vector2d place_m = (shift * board.point_m(rival).homogeneous()).hnormalized();
    for (int circle = 0; circle < board.pointCount(); ++circle) {
      if ((board.point_m(circle) - place_m).norm() < kSamePlace * board.spacing_m)
        rival_of[static_cast<std::size_t>(circle)] = rival;
    }
  }
  return rival_of;
}

std::vector<Eigen::Matrix3d> rivalShifts(const BoardScene& scene, double min_overlap) {
  return scene.edges ? patternShifts(scene.board, *scene.edges, min_overlap)
                     : latticeShifts(scene.board, min_overlap);
}

PlacementWatch::PlacementWatch(const BoardScene& scene, const GridOptions& options)
    : options_(options), shifts_(rivalShifts(scene, options.min_rival_overlap)) {}

void PlacementWatch::begin(std::optional<bool> distinguished) {
  contradicting_ = agreeing_ = wait_ = 0;
  distinguished_ = distinguished;
  sums_.clear();
}

double PlacementWatch::sumUp(std::vector<PlacementScore>& rivals) {
  constexpr double kKept = 0.9;
  if (sums_.empty()) {
    squared_weights_ = 0.0;
    for (const Eigen::Matrix3d& shift : shifts_) sums_.push_back({shift});
  }
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    sums_[k].measured = kKept * sums_[k].measured + rivals[k].measured;
    sums_[k].missing = kKept * sums_[k].missing + rivals[k].missing;
    sums_[k].absent = kKept * sums_[k].absent + rivals[k].absent;
  }
  rivals = sums_;
  squared_weights_ = kKept * kKept * squared_weights_ + 1.0;
  return std::sqrt(squared_weights_);
}

std::optional<Eigen::Matrix3d> PlacementWatch::look(const BurstWindow& window, const WindowTrace& trace,
                                                    const BoardScene& scene, const TrackingOptions& options) {
  // Every circle counts; corners are the same in rivals that differ only in the bits of tags.
  if (!scene.edges && trace.report.circles + options_.ambiguity_margin >= scene.board.pointCount()) {
    agreed(options_.contradicting_looks);  // immediately: no rival explains more
    return std::nullopt;
  }
  std::vector<PlacementScore> rivals =
      rivalPlacements(*trace.motion, shifts_, window, scene, trace.report.half_width_s, options);
  const double margin = options_.ambiguity_margin * (scene.edges ? sumUp(rivals) : 1.0);
  sortByValue(rivals);
  const auto isLaid = [](const PlacementScore& rival) { return rival.shift.isIdentity(0.0); };
  const PlacementScore laid = *std::find_if(rivals.begin(), rivals.end(), isLaid);
  // Sorted by value. A rival that is better only by fewer missing circles is ignored: part of the board may
  // be covered.
  const auto best = std::find_if(rivals.begin(), rivals.end(),
                                 [&](const PlacementScore& rival) { return rival.measured > laid.measured; });
  if (best != rivals.end() && best->value() > laid.value() + margin) return contradicted(best->shift);
  const auto all = [&](auto&& behind) {
    return std::all_of(rivals.begin(), rivals.end(),
                       [&](const PlacementScore& rival) { return isLaid(rival) || behind(rival); });
  };
  distinguished_ = distinguished_.value_or(false) ||
                   all([&](const PlacementScore& rival) { return laid.excludes(rival, margin); });
  // Covered or resting circles are missing without being elsewhere: only visible circles are conclusive.
  const bool surely =
      all([&](const PlacementScore& rival) { return rival.measured + margin < laid.measured; });
  agreed(surely ? agreeing_ + 1 : 0);
  return std::nullopt;
}

std::optional<Eigen::Matrix3d> PlacementWatch::continuationOf(const BoardMotion& expected,
                                                              const BoardMotion& found,
                                                              const Board& board) const {
  constexpr double kNear = 0.6, kFarthest = 1.3;  // of a spacing
  const Eigen::Vector2d low = board.corner_m(), high = low + board.extent_m();
  const std::array<Eigen::Vector2d, 3> places = {low, high, Eigen::Vector2d(low.x(), high.y())};
  const auto at = [](const Eigen::Matrix3d& h, const Eigen::Vector2d& place) -> Eigen::Vector2d {
    return (h * place.homogeneous()).hnormalized();
  };
  const Eigen::Vector2d middle = low + 0.5 * board.extent_m();
  const double spacing_px = (at(expected.ideal_from_board, middle + Eigen::Vector2d(board.spacing_m, 0.0)) -
                             at(expected.ideal_from_board, middle))
                                .norm();
  for (const Eigen::Matrix3d& shift : shifts_) {
    const Eigen::Matrix3d h = found.ideal_from_board * shift;
    double farthest_px = 0.0;
    for (const Eigen::Vector2d& place : places)
      farthest_px = std::max(farthest_px, (at(h, place) - at(expected.ideal_from_board, place)).norm());
    const double middle_px = (at(h, middle) - at(expected.ideal_from_board, middle)).norm();
    if (middle_px < kNear * spacing_px && farthest_px < kFarthest * spacing_px) return shift;
  }
  return std::nullopt;
}

std::optional<Eigen::Matrix3d> PlacementWatch::contradicted(const Eigen::Matrix3d& shift) {
  contradicting_ = contradicting_ > 0 && shift == favourite_ ? contradicting_ + 1 : 1;
  favourite_ = shift;
  agreeing_ = 0;
  distinguished_ = false;
  wait_ = 1;
  if (contradicting_ < options_.contradicting_looks) return std::nullopt;
  contradicting_ = 0;
  sums_.clear();
  return favourite_;
}

void PlacementWatch::agreed(int in_a_row) {
  contradicting_ = 0;
  agreeing_ = in_a_row;
  distinguished_ = distinguished_.value_or(false) || isSettled();
  wait_ = isSettled() ? options_.look_every_windows : 1;
}

}  // namespace evical
