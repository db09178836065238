#include "core/frontend/board_extent.h"

#include "core/frontend/circle_measurement.h"
#include "core/frontend/rival_placements.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace evical {

void countWhole(int lines, LatticeEnds& ends) {
  if (ends.lines_lead == 0) ends.lines = lines;
  ends.lines_lead += lines == ends.lines ? 1 : -1;
}

namespace {

// A row or a column of circles, on the board or beyond it, as a separate board.
struct Line {
  BoardScene scene;
  Eigen::Vector2d origin_m;
};

Line rowOf(const BoardScene& scene, int row) {
  const Board& board = scene.board;
  Line line{scene, {0.0, row * board.spacing_m}};
  line.scene.board.rows = 1;
  if (board.type == BoardType::AsymmetricCircles && row % 2 != 0) line.origin_m.x() = board.spacing_m;
  return line;
}

Line columnOf(const BoardScene& scene, int col) {
  Line line{scene, {scene.board.point_m(0, 1).x() * col, 0.0}};
  line.scene.board.cols = 1;
  return line;
}

// Column before the first or after the last one. Asymmetric boards end with a straight one of every second
// row: turned by half a turn, a larger board has only these circles beyond a part of it.
Line columnBeyond(const BoardScene& scene, bool first) {
  const Board& board = scene.board;
  if (board.type != BoardType::AsymmetricCircles) return columnOf(scene, first ? -1 : board.cols);
  const int first_row = first ? 1 : 0;
  Line line{scene, {(first ? -1 : 2 * board.cols) * board.spacing_m, first_row * board.spacing_m}};
  line.scene.board.type = BoardType::SymmetricCircles;
  line.scene.board.cols = 1;
  line.scene.board.rows = (board.rows + 1 - first_row) / 2;
  line.scene.board.spacing_m = 2.0 * board.spacing_m;
  return line;
}

enum class LineState { OutOfView, Absent, Unclear, Present };

// Difference of a measured circle from its place in the board's fit, and from its size there.
struct Deviation {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  double radius_px = 0.0;
};

Deviation deviationOf(const CircleObservation& circle, const OutlineImage& place, const BoardMotion& motion,
                      double middle_s) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> shape(place.shape);
  return {circle.centre_px - motion.travel(circle.centre_px, circle.time_s - middle_s) - place.centre_px,
          circle.semi_axes_px.maxCoeff() - 1.0 / std::sqrt(shape.eigenvalues().x())};
}

// Evidence of one window: the states of all lines, those `beyond` the board on either side included.
void countLines(const std::vector<LineState>& lines, std::size_t beyond, LatticeEnds& ends) {
  const auto begin = lines.begin() + static_cast<std::ptrdiff_t>(beyond),
             end = lines.end() - (begin - lines.begin());
  const auto inView = [](LineState state) { return state != LineState::OutOfView; };
  const auto first = std::find_if(begin, end, inView);
  const auto last = std::find_if(std::reverse_iterator(end), std::reverse_iterator(begin), inView);
  const std::array outside = {*(begin - 1), *end};
  const std::array edges = {first == end ? LineState::OutOfView : *first,
                            first == end ? LineState::OutOfView : *last};
  const auto any = [](const std::array<LineState, 2>& of, LineState state) {
    return of[0] == state || of[1] == state;
  };
  const bool larger = any(outside, LineState::Present), smaller = any(edges, LineState::Absent);
  if (larger && smaller) return;
  ends.beyond_in_view += larger || any(outside, LineState::Absent) || any(outside, LineState::Unclear);
  ends.beyond_seen += larger;
  ends.edge_in_view += smaller || any(edges, LineState::Present) || any(edges, LineState::Unclear);
  ends.edge_missing += smaller;
}

// Number of lines that are present between absent ones; 0 if their ends are not in view.
int wholeLines(const std::vector<LineState>& lines) {
  const auto isPresent = [](LineState state) { return state == LineState::Present; };
  const auto first = std::find_if(lines.begin(), lines.end(), isPresent);
  const auto end = std::find_if(lines.rbegin(), lines.rend(), isPresent).base();
  if (first == lines.begin() || first == lines.end() || end == lines.end()) return 0;
  const bool is_whole = *(first - 1) == LineState::Absent && *end == LineState::Absent &&
                        std::find(first, end, LineState::Absent) == end;
  return is_whole ? static_cast<int>(end - first) : 0;
}

void judgeLines(const std::vector<LineState>& lines, std::size_t beyond, LatticeEnds& ends) {
  countLines(lines, beyond, ends);
  if (const int whole = wholeLines(lines); whole > 0) countWhole(whole, ends);
}

class ExtentJudge {
 public:
  ExtentJudge(const BurstWindow& window, const WindowTrace& trace, const BoardScene& scene,
              const FrontEndOptions& options)
      : window_(window),
        trace_(trace),
        scene_(scene),
        options_(options),
        centre_sigma_px_(options.extent.min_sigma_px),
        radius_sigma_px_(options.extent.min_sigma_px) {
    // The information of the board's fit, in squares of a circle's sigma.
    Eigen::Matrix<double, 8, 8> information = 1e-6 * Eigen::Matrix<double, 8, 8>::Identity();
    double centres_px2 = 0.0, radii_px2 = 0.0, radii_px = 0.0, count = 0.0;
    for (const CircleObservation& circle : trace.circles) {
      const auto place = imageOfCircle(trace.motion->ideal_from_board, scene, circle.circle);
      if (!place) continue;
      const Deviation deviation = deviationOf(circle, *place, *trace.motion, trace.report.time_s);
      const PlaneFlowBasis basis = trace.motion->frame.basis(place->centre_px);
      information += basis.transpose() * basis;
      centres_px2 += 0.5 * deviation.centre_px.squaredNorm();
      radii_px2 += deviation.radius_px * deviation.radius_px;
      radii_px += deviation.radius_px;
      ++count;
    }
    if (count == 0.0) return;
    fit_.compute(information);
    radius_px_ = radii_px / count;
    radius_sigma_px_ = std::max(radius_sigma_px_, std::sqrt(radii_px2 / count - radius_px_ * radius_px_));
    centre_sigma_px_ = std::max(centre_sigma_px_, std::sqrt(centres_px2 / count));
  }

  void judge(bool of_rows, LatticeEnds& ends) const {
    const int count = of_rows ? scene_.board.rows : scene_.board.cols;
    std::vector<LineState> lines = {beyond(of_rows ? rowOf(scene_, -1) : columnBeyond(scene_, true))};
    for (int k = 0; k < count; ++k) lines.push_back(stateOfOwn(k, of_rows));
    lines.push_back(beyond(of_rows ? rowOf(scene_, count) : columnBeyond(scene_, false)));
    judgeLines(lines, 1, ends);
  }

 private:
  double halfSlot_s() const { return trace_.report.half_width_s; }

  BoardMotion motionOf(const Line& line) const {
    BoardMotion motion = *trace_.motion;
    Eigen::Matrix3d shift = Eigen::Matrix3d::Identity();
    shift.topRightCorner<2, 1>() = line.origin_m;
    motion.ideal_from_board = trace_.motion->ideal_from_board * shift;
    return motion;
  }

  // Sigma per axis of a circle's place by the board's fit, whose errors are larger than those of the circles
  // beyond the board.
  double placeSigma_px(const Eigen::Vector2d& pixel) const {
    const PlaneFlowBasis basis = trace_.motion->frame.basis(pixel);
    const double fit = (basis * fit_.solve(basis.transpose())).trace();
    return centre_sigma_px_ * std::sqrt(1.0 + 0.5 * fit);
  }

  // Circles that are where the board's lattice continues, and of the size of its circles, as precisely as its
  // own ones.
  int alike(const Line& line, const BoardMotion& motion) const {
    const double sigmas = options_.extent.alike_sigmas;
    int count = 0;
    for (const CircleObservation& circle :
         measureCircles(window_, motion, line.scene, {halfSlot_s()}, options_.tracking)) {
      const auto place = imageOfCircle(motion.ideal_from_board, line.scene, circle.circle);
      if (!place) continue;
      const Deviation deviation =
          deviationOf(circle, *place, motion, 1e-9 * static_cast<double>(motion.time_ns));
      count += deviation.centre_px.norm() < sigmas * placeSigma_px(place->centre_px) &&
               std::abs(deviation.radius_px - radius_px_) < sigmas * radius_sigma_px_;
    }
    return count;
  }

  LineState stateOf(const Line& line, int seen) const {
    return stateOf(line, motionOf(line), seen, options_.extent.min_line, 2);
  }
  LineState stateOf(const Line& line, const BoardMotion& motion, int seen, double min_share,
                    int min_circles) const {
    const int expected = expectedCircles(motion, line.scene, halfSlot_s());
    const double least = min_circles;
    if (expected < std::max(least, min_share * line.scene.board.pointCount())) return LineState::OutOfView;
    if (seen >= std::max(least, min_share * expected)) return LineState::Present;
    return seen <= (1.0 - options_.extent.min_line) * 0.5 * expected ? LineState::Absent : LineState::Unclear;
  }

  // Discs of the background are on one line by chance now and then. So most of the line must be in view, and
  // there must be three circles of it, if it has as many.
  LineState beyond(const Line& line) const {
    const BoardMotion motion = motionOf(line);
    const ExtentOptions& extent = options_.extent;
    return stateOf(line, motion, alike(line, motion), extent.min_line_beyond,
                   std::min(extent.min_circles_beyond, line.scene.board.pointCount()));
  }

  LineState stateOfOwn(int k, bool rows) const {
    const auto seen = std::count_if(
        trace_.circles.begin(), trace_.circles.end(),
        [&](const CircleObservation& circle) { return scene_.board.lineOf(circle.circle, rows) == k; });
    return stateOf(rows ? rowOf(scene_, k) : columnOf(scene_, k), static_cast<int>(seen));
  }

  const BurstWindow& window_;
  const WindowTrace& trace_;
  const BoardScene& scene_;
  const FrontEndOptions& options_;
  double centre_sigma_px_, radius_sigma_px_, radius_px_ = 0.0;  // of the board's own circles
  Eigen::LDLT<Eigen::Matrix<double, 8, 8>> fit_;                // of its information
};

// The same for corners. A line beyond the board's end has the corners of a larger pattern only if the pattern
// continues, so that they need no comparison with the board's own.
class CornerExtentJudge {
 public:
  CornerExtentJudge(const BurstWindow& window, const WindowTrace& trace, const BoardScene& scene,
                    const FrontEndOptions& options)
      : larger_(scene), options_(options) {
    larger_.board.rows += 2 * kBeyond;
    larger_.board.cols += 2 * kBeyond;
    larger_.edges = edgesOf(larger_.board, {.blank = true});
    Eigen::Matrix3d origin = Eigen::Matrix3d::Identity();
    origin.topRightCorner<2, 1>().setConstant(-kBeyond * scene.board.spacing_m);
    const BoardMotion motion = shifted(*trace.motion, origin);
    const double half_s = trace.report.half_width_s;
    for (const bool of_rows : {true, false})
      lines_[of_rows].resize(static_cast<std::size_t>(larger_.board.lineCount(of_rows)));
    // Lines are as long as the board's own ones.
    const auto isOwn = [&](int line, bool of_rows) {
      return line >= kBeyond && line < larger_.board.lineCount(of_rows) - kBeyond;
    };
    const auto count = [&](int corner, int Counts::*what) {
      for (const bool of_rows : {true, false})
        if (isOwn(larger_.board.lineOf(corner, !of_rows), !of_rows))
          ++(lines_[of_rows][static_cast<std::size_t>(larger_.board.lineOf(corner, of_rows))].*what);
    };
    for (const CircleObservation& corner :
         measureCircles(window, motion, larger_, {half_s}, options.tracking))
      count(corner.circle, &Counts::seen);
    for (const int corner : circlesExpected(motion, larger_, half_s)) count(corner, &Counts::expected);
  }

  void judge(bool of_rows, LatticeEnds& ends) const {
    std::vector<LineState> lines;
    for (const Counts& line : lines_[of_rows]) lines.push_back(stateOf(line, of_rows));
    judgeLines(lines, kBeyond, ends);
  }

 private:
  static constexpr int kBeyond = 4;  // lines on each side

  struct Counts {
    int expected = 0, seen = 0;
  };

  LineState stateOf(const Counts& line, bool of_rows) const {
    const int own = larger_.board.lineCount(!of_rows) - 2 * kBeyond, all = larger_.board.lineCount(!of_rows);
    const double in_line = static_cast<double>(larger_.board.pointCount()) /
                           static_cast<double>(lines_[of_rows].size()) * own / all;
    const double least =
        std::max<double>(options_.extent.min_circles_beyond, options_.extent.min_line * in_line);
    const int in_view = std::max(line.expected, line.seen);
    if (in_view < least) return LineState::OutOfView;
    const double share = static_cast<double>(line.seen) / in_view;
    if (share >= options_.extent.min_line) return LineState::Present;
    return share <= (1.0 - options_.extent.min_line) * 0.5 ? LineState::Absent : LineState::Unclear;
  }
  BoardScene larger_;
  const FrontEndOptions& options_;
  std::array<std::vector<Counts>, 2> lines_;  // of columns and of rows, the board's own ones from kBeyond on
};

}  // namespace

void judgeExtent(const BurstWindow& window, const WindowTrace& trace, const BoardScene& scene,
                 const FrontEndOptions& options, BoardExtent& extent) {
  if (scene.edges) {
    const CornerExtentJudge judge(window, trace, scene, options);
    judge.judge(true, extent.rows);
    judge.judge(false, extent.cols);
    return;
  }
  const ExtentJudge judge(window, trace, scene, options);
  judge.judge(true, extent.rows);
  judge.judge(false, extent.cols);
}

}  // namespace evical
