#include "core/frontend/board_extent.h"

#include "core/frontend/circle_measurement.h"

#include <algorithm>
#include <array>

namespace evical {
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

enum class LineState { OutOfView, Absent, Unclear, Present };

class ExtentJudge {
 public:
  ExtentJudge(const BurstWindow& window, const WindowTrace& trace, const BoardScene& scene,
              const FrontEndOptions& options)
      : window_(window), trace_(trace), scene_(scene), options_(options) {}

  void judgeRows(LatticeEnds& ends) const {
    const int rows = scene_.board.rows;
    count({beyond(rowOf(scene_, -1)), beyond(rowOf(scene_, rows))},
          {firstInView(0, 1, rows, true), firstInView(rows - 1, -1, rows, true)}, ends);
  }
  void judgeColumns(LatticeEnds& ends) const {
    const int cols = scene_.board.cols;
    count({beyond(columnOf(scene_, -1)), beyond(columnOf(scene_, cols))},
          {firstInView(0, 1, cols, false), firstInView(cols - 1, -1, cols, false)}, ends);
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

  LineState stateOf(const Line& line, int seen) const {
    const int expected = expectedCircles(motionOf(line), line.scene, halfSlot_s());
    const double least = options_.extent.least_line;
    if (expected < std::max(2.0, least * line.scene.board.pointCount())) return LineState::OutOfView;
    if (seen >= std::max(2.0, least * expected)) return LineState::Present;
    return seen <= (1.0 - least) * 0.5 * expected ? LineState::Absent : LineState::Unclear;
  }

  LineState beyond(const Line& line) const {
    const auto seen = measureCircles(window_, motionOf(line), line.scene, {halfSlot_s()}, options_.tracking);
    return stateOf(line, static_cast<int>(seen.size()));
  }

  // First line of the board in the image, from an edge inwards.
  LineState firstInView(int from, int step, int lines, bool rows) const {
    for (int k = from; k >= 0 && k < lines; k += step) {
      const auto seen =
          std::count_if(trace_.circles.begin(), trace_.circles.end(), [&](const CircleObservation& circle) {
            return (rows ? circle.circle / scene_.board.cols : circle.circle % scene_.board.cols) == k;
          });
      const Line line = rows ? rowOf(scene_, k) : columnOf(scene_, k);
      const LineState state = stateOf(line, static_cast<int>(seen));
      if (state != LineState::OutOfView) return state;
    }
    return LineState::OutOfView;
  }

  static void count(std::array<LineState, 2> beyond, std::array<LineState, 2> edges, LatticeEnds& ends) {
    const auto any = [](const std::array<LineState, 2>& lines, LineState state) {
      return lines[0] == state || lines[1] == state;
    };
    const bool larger = any(beyond, LineState::Present), smaller = any(edges, LineState::Absent);
    if (larger && smaller) return;
    ends.beyond_in_view += larger || any(beyond, LineState::Absent) || any(beyond, LineState::Unclear);
    ends.beyond_seen += larger;
    ends.edge_in_view += smaller || any(edges, LineState::Present) || any(edges, LineState::Unclear);
    ends.edge_missing += smaller;
  }

  const BurstWindow& window_;
  const WindowTrace& trace_;
  const BoardScene& scene_;
  const FrontEndOptions& options_;
};

}  // namespace

void judgeExtent(const BurstWindow& window, const WindowTrace& trace, const BoardScene& scene,
                 const FrontEndOptions& options, BoardExtent& extent) {
  const ExtentJudge judge(window, trace, scene, options);
  judge.judgeRows(extent.rows);
  judge.judgeColumns(extent.cols);
}

}  // namespace evical
