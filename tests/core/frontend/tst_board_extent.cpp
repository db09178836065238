#include "core/frontend/board_extent.h"

#include "core/frontend/circle_measurement.h"
#include "tests/core/frontend/synthetic_bursts.h"
#include "tests/support/test_program.h"

#include <span>
#include <utility>

namespace {

using namespace evical;
using namespace evical::test;

constexpr double kBoardExtentHalfWindow_s = 0.02;

// The session's extent of the existing board: that many rows and columns, from this row and column on, or
// backwards.
struct Claim {
  int rows, cols, first_row = 0, first_col = 0;
  bool half_turn = false;
};

BoardExtent judge(const MovingBoard& moving, const Claim& claim, int random_bursts = 0,
                  std::span<const SyntheticCircle> discs = {}) {
  std::mt19937 random(7);
  std::vector<EdgeCrossing> bursts = burstsOf(moving, kBoardExtentHalfWindow_s, 0.1, random);
  addRandomBursts(random_bursts, kBoardExtentHalfWindow_s, random, bursts);
  for (const SyntheticCircle& disc : discs)
    addBursts(disc, kBoardExtentHalfWindow_s, moving.board.circles, 0.1, random, bursts);
  const SyntheticWindow synthetic(bursts, moving.board.circles);
  Board claimed = moving.board;
  claimed.rows = claim.rows;
  claimed.cols = claim.cols;
  Eigen::Matrix3d shift = Eigen::Matrix3d::Identity();
  shift.topRightCorner<2, 1>() = moving.board.point_m(claim.first_row, claim.first_col);
  if (claim.half_turn) shift.diagonal().head<2>().setConstant(-1.0);
  BoardMotion motion = moving.motionAt(0.0);
  motion.ideal_from_board = motion.ideal_from_board * shift;
  motion.ideal_from_board /= motion.ideal_from_board(2, 2);
  motion.residual_rms_px = 0.1;
  const FrontEndOptions options;
  const BoardScene scene(claimed, kDavis_px, std::nullopt);
  WindowTrace trace;
  trace.motion = motion;
  trace.circles =
      measureCircles(synthetic.window, motion, scene, {kBoardExtentHalfWindow_s}, options.tracking);
  trace.report.half_width_s = kBoardExtentHalfWindow_s;
  BoardExtent extent;
  judgeExtent(synthetic.window, trace, scene, options, extent);
  return extent;
}

// Discs of the background, some of them near places where a larger board would have circles.
std::vector<SyntheticCircle> discsBeside(const MovingBoard& moving, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Board larger = moving.board;  // by a line to all sides, with the same places
  larger.rows += 4;
  larger.cols += 2;
  Eigen::Matrix3d shift = Eigen::Matrix3d::Identity();
  shift.topRightCorner<2, 1>() = -larger.point_m(2, 1);
  const BoardScene scene(larger, kDavis_px, std::nullopt);
  std::vector<SyntheticCircle> discs;
  for (int row = 1; row < larger.rows - 1; ++row)
    for (int col = 0; col < larger.cols; ++col) {
      const bool on_board = row >= 2 && row < larger.rows - 2 && col >= 1 && col < larger.cols - 1;
      const auto place = imageOfCircle(moving.homographyAt(0.0) * shift, scene, row * larger.cols + col);
      if (on_board || !place || uniform(random) < -0.2) continue;
      const Eigen::Vector2d velocity_px_s = moving.motionAt(0.0).velocityAt(place->centre_px);
      discs.push_back({place->centre_px + 2.0 * Eigen::Vector2d(uniform(random), uniform(random)),
                       (1.0 + 0.1 * uniform(random)) * velocity_px_s,
                       (1.0 + 0.1 * uniform(random)) * place->max_radius_px});
    }
  return discs;
}

QString describe(const LatticeEnds& ends) {
  return QString("beyond %1 of %2, missing %3 of %4")
      .arg(ends.beyond_seen)
      .arg(ends.beyond_in_view)
      .arg(ends.edge_missing)
      .arg(ends.edge_in_view);
}

class TestBoardExtent : public QObject {
  Q_OBJECT
 private slots:
  void lattice_isHeldAgainstTheClaim_data();
  void lattice_isHeldAgainstTheClaim();
  void largerBoards_areLarger();
  void boardTurnedByHalfATurn_isLarger();
  void symmetricBoard_isJudgedAlike();
  void clutter_isNoLine();
  void discsOfTheBackground_areNoLine();
  void boardOneStepOff_saysNothing();
  void boardCutByTheImage_isNotSmaller();
};

void TestBoardExtent::lattice_isHeldAgainstTheClaim_data() {
  QTest::addColumn<int>("rows");
  QTest::addColumn<int>("cols");
  QTest::addColumn<int>("first_row");
  QTest::addColumn<int>("first_col");
  QTest::addColumn<QString>("rows_are");
  QTest::addColumn<QString>("cols_are");
  const char* const right = "beyond 0 of 1, missing 0 of 1";
  const char* const larger = "beyond 1 of 1, missing 0 of 1";
  const char* const smaller = "beyond 0 of 1, missing 1 of 1";
  QTest::newRow("11 x 4") << 11 << 4 << 0 << 0 << right << right;
  QTest::newRow("first rows of 11") << 9 << 4 << 0 << 0 << larger << right;
  QTest::newRow("last rows of 11") << 9 << 4 << 2 << 0 << larger << right;
  QTest::newRow("first columns of 4") << 11 << 3 << 0 << 0 << right << larger;
  QTest::newRow("last columns of 4") << 11 << 3 << 0 << 1 << right << larger;
  QTest::newRow("rows and columns in the middle") << 7 << 2 << 2 << 1 << larger << larger;
  QTest::newRow("two rows more") << 13 << 4 << 0 << 0 << smaller << right;
  QTest::newRow("one column more") << 11 << 5 << 0 << 0 << right << smaller;
  QTest::newRow("a row more, a column less") << 12 << 3 << 0 << 0 << smaller << larger;
}

void TestBoardExtent::lattice_isHeldAgainstTheClaim() {
  QFETCH(int, rows);
  QFETCH(int, cols);
  QFETCH(int, first_row);
  QFETCH(int, first_col);
  for (const CircleShade shade : {CircleShade::Dark, CircleShade::Bright}) {
    MovingBoard moving;
    moving.board.circles = shade;
    const BoardExtent extent = judge(moving, {rows, cols, first_row, first_col});
    QTEST(describe(extent.rows), "rows_are");
    QTEST(describe(extent.cols), "cols_are");
  }
}

// Rows and columns beyond 9 x 4.
void TestBoardExtent::largerBoards_areLarger() {
  for (const auto& [rows, cols] : {std::pair{11, 4}, std::pair{11, 5}, std::pair{13, 4}, std::pair{9, 5}})
    for (const int first_row : {0, rows - 9})
      for (const int first_col : {0, cols - 4}) {
        MovingBoard moving;
        moving.board.rows = rows;
        moving.board.cols = cols;
        const BoardExtent extent = judge(moving, {9, 4, first_row, first_col});
        QCOMPARE(extent.rows.beyond_seen, rows > 9 ? 1 : 0);
        QCOMPARE(extent.cols.beyond_seen, cols > 4 ? 1 : 0);
      }
}

// Half of the circles of a column are then beyond one end, and half beyond the other one.
void TestBoardExtent::boardTurnedByHalfATurn_isLarger() {
  QCOMPARE(describe(judge(MovingBoard{}, {11, 3, 10, 3, true}).cols), "beyond 1 of 1, missing 0 of 1");
  QCOMPARE(describe(judge(MovingBoard{}, {9, 3, 10, 3, true}).cols), "beyond 1 of 1, missing 0 of 1");
  MovingBoard larger;
  larger.board.cols = 5;
  QCOMPARE(describe(judge(larger, {11, 4, 10, 4, true}).cols), "beyond 1 of 1, missing 0 of 1");
}

void TestBoardExtent::symmetricBoard_isJudgedAlike() {
  MovingBoard moving;
  moving.board = {BoardType::SymmetricCircles, 6, 7, 0.03, 0.01, CircleShade::Dark, 0.0, {}};
  QCOMPARE(describe(judge(moving, {6, 7}).rows), "beyond 0 of 1, missing 0 of 1");
  QCOMPARE(describe(judge(moving, {5, 7}).rows), "beyond 1 of 1, missing 0 of 1");
  QCOMPARE(describe(judge(moving, {6, 6, 0, 1}).cols), "beyond 1 of 1, missing 0 of 1");
  QCOMPARE(describe(judge(moving, {6, 8}).cols), "beyond 0 of 1, missing 1 of 1");
}

void TestBoardExtent::clutter_isNoLine() {
  const BoardExtent extent = judge(MovingBoard{}, {11, 4}, 8000);
  QCOMPARE(extent.rows.beyond_seen, 0);
  QCOMPARE(extent.cols.beyond_seen, 0);
}

// Boards that fill the image, so that only a part of the lines beyond them is in view.
void TestBoardExtent::discsOfTheBackground_areNoLine() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  constexpr int kViews = 60;
  int seen = 0, in_view = 0;
  for (int view = 0; view < kViews; ++view) {
    MovingBoard moving;
    moving.board.rows = 9;
    moving.middle_m = {0.12 * uniform(random), 0.08 * uniform(random), 0.42};
    const std::vector<SyntheticCircle> discs = discsBeside(moving, random);
    const BoardExtent extent = judge(moving, {9, 4}, 0, discs);
    seen += extent.rows.beyond_seen + extent.cols.beyond_seen;
    in_view += extent.rows.beyond_in_view + extent.cols.beyond_in_view;
  }
  QVERIFY2(in_view > kViews / 2, qPrintable(QString::number(in_view)));
  QVERIFY2(20 * seen < in_view, qPrintable(QString("%1 of %2").arg(seen).arg(in_view)));
}

void TestBoardExtent::boardOneStepOff_saysNothing() {
  const BoardExtent extent = judge(MovingBoard{}, {11, 4, 2, 0});
  QCOMPARE(describe(extent.rows), "beyond 0 of 0, missing 0 of 0");
}

void TestBoardExtent::boardCutByTheImage_isNotSmaller() {
  MovingBoard moving;
  moving.middle_m = {0.1, 0.15, 0.5};
  const BoardExtent extent = judge(moving, {11, 4});
  QCOMPARE(describe(extent.rows), "beyond 0 of 1, missing 0 of 1");
  QCOMPARE(describe(extent.cols), "beyond 0 of 1, missing 0 of 1");
}

}  // namespace

EVICAL_TEST(TestBoardExtent)
#include "tst_board_extent.moc"
