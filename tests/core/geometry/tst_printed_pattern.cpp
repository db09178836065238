#include "core/geometry/printed_pattern.h"

#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>

namespace {

using namespace evical;

Board grid(BoardType type) {
  Board board;
  board.type = type;
  board.rows = 4;
  board.cols = 5;
  board.spacing_m = 0.13;
  board.radius_m = 0.0;
  board.tag_size_m = type == BoardType::Checkerboard ? 0.0 : 0.1;
  return board;
}

class TestPrintedPattern : public QObject {
  Q_OBJECT
 private slots:
  void inkBoxes_coverTheInk_data();
  void inkBoxes_coverTheInk();
  void edges_haveInkOnOneSide_data() { inkBoxes_coverTheInk_data(); }
  void edges_haveInkOnOneSide();
  void edges_endAtTheCornersOfCheckerboards();
};

void TestPrintedPattern::inkBoxes_coverTheInk_data() {
  QTest::addColumn<int>("type");
  for (const BoardType type : {BoardType::Checkerboard, BoardType::AprilGrid, BoardType::Charuco})
    QTest::newRow(boardTypeName(type)) << static_cast<int>(type);
}

void TestPrintedPattern::inkBoxes_coverTheInk() {
  QFETCH(int, type);
  const PrintedPattern pattern(grid(static_cast<BoardType>(type)), {});
  const std::vector<PaintedBox> boxes = pattern.inkBoxes();
  for (double y = -0.201; y < 0.8; y += 0.0073) {
    for (double x = -0.201; x < 0.9; x += 0.0073) {
      const Eigen::Vector2d at(x, y);
      const auto count = std::count_if(boxes.begin(), boxes.end(), [&](const PaintedBox& box) {
        return (at.array() >= box.corner_m.array()).all() &&
               (at.array() < (box.corner_m + box.size_m).array()).all();
      });
      QCOMPARE(count, pattern.isInk(at) ? 1 : 0);
    }
  }
}

void TestPrintedPattern::edges_haveInkOnOneSide() {
  QFETCH(int, type);
  const PrintedPattern pattern(grid(static_cast<BoardType>(type)), {});
  const std::vector<PrintedEdge> edges = pattern.edges();
  QVERIFY(edges.size() > 30);
  for (const PrintedEdge& edge : edges) {
    QVERIFY(edge.length_m() > 0.0 && edge.ink_m > 0.0 && edge.paper_m > 0.0);
    for (const double part : {0.01, 0.5, 0.99}) {
      const Eigen::Vector2d at = edge.from_m + part * (edge.to_m - edge.from_m);
      for (const double share : {0.02, 0.98}) {
        QVERIFY(pattern.isInk(at - share * std::min(edge.ink_m, 1.0) * edge.paper));
        QVERIFY(!pattern.isInk(at + share * std::min(edge.paper_m, 1.0) * edge.paper));
      }
    }
  }
}

void TestPrintedPattern::edges_endAtTheCornersOfCheckerboards() {
  const Board board = grid(BoardType::Checkerboard);
  const std::vector<PrintedEdge> edges = PrintedPattern(board, {}).edges();
  for (int k = 0; k < board.pointCount(); ++k) {
    const auto ends = std::count_if(edges.begin(), edges.end(), [&](const PrintedEdge& edge) {
      return std::min((edge.from_m - board.point_m(k)).norm(), (edge.to_m - board.point_m(k)).norm()) < 1e-9;
    });
    QCOMPARE(ends, 4);
  }
}

}  // namespace

EVICAL_TEST(TestPrintedPattern)
#include "tst_printed_pattern.moc"
