#include "core/pipeline/detection/board_size_check.h"

#include "core/base/error.h"
#include "tests/support/test_program.h"

#include <QRegularExpression>

namespace {

using namespace evical;

// Views of a board in which only the first rows and columns are ever seen.
BoardObservations observe(const Board& board, int rows_seen, int cols_seen, const BoardExtent& extent) {
  BoardObservations observations;
  observations.camera = "left";
  observations.extent = extent;
  BoardView view;
  for (int row = 0; row < rows_seen; ++row) {
    for (int col = 0; col < cols_seen; ++col) {
      view.circles.emplace_back();
      view.circles.back().circle = board.index(row, col);
    }
  }
  observations.views.assign(800, view);
  return observations;
}

std::string failureOfBoardSizeCheck(const Board& board, const BoardObservations& observations) {
  try {
    checkBoardSize(observations, board, ExtentOptions{});
  } catch (const CalibrationError& error) {
    return error.what();
  }
  return {};
}

std::string failureOfBoardSizeCheck(const Board& board, int rows_seen, int cols_seen,
                                    const BoardExtent& extent) {
  return failureOfBoardSizeCheck(board, observe(board, rows_seen, cols_seen, extent));
}

#define VERIFY_SAYS(text, part) \
  QVERIFY2(QString::fromStdString(text).contains(QRegularExpression(part)), (text).c_str())

class TestBoardSizeCheck : public QObject {
  Q_OBJECT
 private slots:
  void rightBoard_passes();
  void fewViews_sayNothing();
  void largerBoard_isNamedWithItsSide();
  void smallerBoard_isNamedWithWhatWasNeverSeen();
  void smallerBoard_seenAtEitherEnd_isNamed();
  void boardWhoseReadOutLosesBursts_passes();
  void otherBoard_isBoth();
  void circlesNeverSeen_areWorthAWarning();
};

void TestBoardSizeCheck::rightBoard_passes() {
  const BoardExtent extent{{3, 0, 80, 0}, {80, 5, 80, 4}};
  QCOMPARE(failureOfBoardSizeCheck({}, 11, 4, extent), std::string());
}

void TestBoardSizeCheck::fewViews_sayNothing() {
  const BoardExtent extent{{14, 14, 14, 14}, {0, 0, 0, 0}};
  QCOMPARE(failureOfBoardSizeCheck({}, 11, 4, extent), std::string());
}

void TestBoardSizeCheck::largerBoard_isNamedWithItsSide() {
  Board board;
  board.rows = 9;
  const std::string rows = failureOfBoardSizeCheck(board, 9, 4, {{80, 76, 80, 0}, {80, 0, 80, 0}});
  VERIFY_SAYS(rows, "left: .*seems larger than 9 x 4: .*beyond its first or last row in 95 % of 80 views");
  VERIFY_SAYS(rows, "Check rows and columns in the session");
  VERIFY_SAYS(failureOfBoardSizeCheck(board, 9, 4, {{80, 0, 80, 0}, {80, 80, 80, 0}}),
              "beyond its first or last column");
}

void TestBoardSizeCheck::smallerBoard_isNamedWithWhatWasNeverSeen() {
  Board board;
  board.rows = 13;
  VERIFY_SAYS(failureOfBoardSizeCheck(board, 11, 4, {{80, 0, 80, 75}, {80, 0, 80, 0}}),
              "seems smaller than 13 x 4: the last 2 of 13 rows were never seen in 800 views");
  VERIFY_SAYS(failureOfBoardSizeCheck(board, 13, 3, {{80, 0, 80, 0}, {80, 0, 80, 75}}),
              "the last 1 of 4 columns was never seen in 800 views");
}

// A board of ten rows in a session of eleven is placed on either end of them.
void TestBoardSizeCheck::smallerBoard_seenAtEitherEnd_isNamed() {
  const Board board;
  BoardObservations observations = observe(board, 10, 4, {{80, 0, 80, 72}, {80, 0, 80, 0}});
  for (std::size_t k = 0; k < observations.views.size(); k += 2)
    for (CircleObservation& circle : observations.views[k].circles) circle.circle += board.cols;
  VERIFY_SAYS(failureOfBoardSizeCheck(board, observations),
              "smaller than 11 x 4: its first or last row is missing in 90 % of the 80 views");
}

// A column that is missing in 39 % of the views is present in the others.
void TestBoardSizeCheck::boardWhoseReadOutLosesBursts_passes() {
  Board board;
  board.rows = 9;
  BoardObservations observations = observe(board, 9, 4, {{248, 0, 248, 0}, {248, 0, 248, 97}});
  for (std::size_t k = 0; k < observations.views.size(); ++k)
    if (k % 5 != 0)
      std::erase_if(observations.views[k].circles,
                    [&](const CircleObservation& circle) { return circle.circle % board.cols == 0; });
  QCOMPARE(failureOfBoardSizeCheck(board, observations), std::string());
}

void TestBoardSizeCheck::otherBoard_isBoth() {
  VERIFY_SAYS(failureOfBoardSizeCheck({}, 10, 4, {{80, 0, 80, 72}, {80, 79, 80, 0}}),
              "seems different from 11 x 4: the last 1 of 11 rows was never seen in 800 views, and "
              "circles.*beyond its first or last column");
}

void TestBoardSizeCheck::circlesNeverSeen_areWorthAWarning() {
  const Board board;
  QVERIFY(!unseenCircles(observe(board, 11, 4, {}), board));
  const auto fault = unseenCircles(observe(board, 10, 4, {}), board);
  QVERIFY(fault);
  VERIFY_SAYS(fault->text, "4 of the board's 44 circles.*any of 800 views: check its rows and columns");
  Board tags = board;
  tags.type = BoardType::AprilGrid;
  VERIFY_SAYS(unseenCircles(observe(tags, 10, 4, {}), tags)->text, "check its rows, columns and first_tag");
}

}  // namespace

EVICAL_TEST(TestBoardSizeCheck)
#include "tst_board_size_check.moc"
