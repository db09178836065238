#include "core/geometry/board.h"

#include "core/base/error.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <limits>

namespace {

using namespace evical;

Board board(BoardType type, int rows, int cols) {
  Board made;
  made.type = type;
  made.rows = rows;
  made.cols = cols;
  made.spacing_m = 0.05;
  made.radius_m = 0.02;
  return made;
}

// True if the centres, rotated by 180 degrees about their mean, are the same centres.
bool turnedIsTheSame(const Board& board) {
  const std::vector<Eigen::Vector2d> centres = boardPoints_m(board);
  Eigen::Vector2d low = centres[0], high = centres[0];
  for (const Eigen::Vector2d& centre : centres) {
    low = low.cwiseMin(centre);
    high = high.cwiseMax(centre);
  }
  return std::all_of(centres.begin(), centres.end(), [&](const Eigen::Vector2d& centre) {
    return std::any_of(centres.begin(), centres.end(), [&](const Eigen::Vector2d& other) {
      return (low + high - centre - other).norm() < 1e-12;
    });
  });
}

}  // namespace

class TestBoard : public QObject {
  Q_OBJECT

 private slots:
  void asymmetricCentres_areStaggered() {
    const Board b = board(BoardType::AsymmetricCircles, 11, 4);
    QCOMPARE(b.pointCount(), 44);
    QVERIFY((b.point_m(0, 0) - Eigen::Vector2d(0.0, 0.0)).norm() < 1e-15);
    QVERIFY((b.point_m(0, 3) - Eigen::Vector2d(0.30, 0.0)).norm() < 1e-15);
    QVERIFY((b.point_m(1, 0) - Eigen::Vector2d(0.05, 0.05)).norm() < 1e-15);
    QVERIFY((b.point_m(10, 3) - Eigen::Vector2d(0.30, 0.50)).norm() < 1e-15);
  }

  void symmetricCentres_areInRowsAndColumns() {
    const Board b = board(BoardType::SymmetricCircles, 3, 5);
    QVERIFY((b.point_m(1, 0) - Eigen::Vector2d(0.0, 0.05)).norm() < 1e-15);
    QVERIFY((b.point_m(2, 4) - Eigen::Vector2d(0.20, 0.10)).norm() < 1e-15);
  }

  void extent_isBetweenTheOutermostCentres() {
    const auto is = [](const Eigen::Vector2d& extent_m, double x_m, double y_m) {
      return (extent_m - Eigen::Vector2d(x_m, y_m)).norm() < 1e-15;
    };
    QVERIFY(is(board(BoardType::AsymmetricCircles, 11, 4).extent_m(), 0.35, 0.50));
    QVERIFY(is(board(BoardType::AsymmetricCircles, 4, 3).extent_m(), 0.25, 0.15));
    QVERIFY(is(board(BoardType::SymmetricCircles, 3, 5).extent_m(), 0.20, 0.10));
  }

  void index_goesByRows_andBack() {
    const Board b = board(BoardType::AsymmetricCircles, 11, 4);
    QCOMPARE(b.index(0, 3), 3);
    QCOMPARE(b.index(1, 0), 4);
    QCOMPARE(b.index(10, 3), 43);
    const std::vector<Eigen::Vector2d> all = boardPoints_m(b);
    QCOMPARE(all.size(), std::size_t(44));
    for (int row = 0; row < b.rows; ++row) {
      for (int col = 0; col < b.cols; ++col) {
        QCOMPARE(b.point_m(b.index(row, col)), b.point_m(row, col));
        QCOMPARE(all[static_cast<std::size_t>(b.index(row, col))], b.point_m(row, col));
      }
    }
  }

  void halfTurnAmbiguity_isSaidWhereThePatternHasIt_data() {
    QTest::addColumn<int>("type");
    QTest::addColumn<int>("rows");
    QTest::addColumn<int>("cols");
    for (const BoardType type : {BoardType::AsymmetricCircles, BoardType::SymmetricCircles})
      for (const int rows : {2, 3, 10, 11})
        for (const int cols : {2, 3, 4})
          QTest::addRow("type %d, %d x %d", static_cast<int>(type), rows, cols)
              << static_cast<int>(type) << rows << cols;
  }
  void halfTurnAmbiguity_isSaidWhereThePatternHasIt() {
    QFETCH(int, type);
    QFETCH(int, rows);
    QFETCH(int, cols);
    const Board b = board(static_cast<BoardType>(type), rows, cols);
    QCOMPARE(b.hasHalfTurnAmbiguity(), turnedIsTheSame(b));
  }

  // Four per tag, tags from the bottom left in Kalibr's order; x to the right, y down from the top left tag's
  // corner.
  void aprilGrid_isCountedAsKalibrDoes() {
    Board b = board(BoardType::AprilGrid, 2, 3);
    b.radius_m = 0.0;
    b.tag_size_m = 0.04;
    validate(b);
    QCOMPARE(b.pointCount(), 24);
    const auto isAt = [&](int index, double x_m, double y_m) {
      return (b.point_m(index) - Eigen::Vector2d(x_m, y_m)).norm() < 1e-12;
    };
    QVERIFY(isAt(0, 0.0, 0.09) && isAt(1, 0.04, 0.09) && isAt(2, 0.04, 0.05) && isAt(3, 0.0, 0.05));
    QVERIFY(isAt(8, 0.10, 0.09) && isAt(12, 0.0, 0.04) && isAt(15, 0.0, 0.0) && isAt(22, 0.14, 0.0));
    QVERIFY((b.extent_m() - Eigen::Vector2d(0.14, 0.09)).norm() < 1e-12);
    QVERIFY(!b.hasHalfTurnAmbiguity());
    b.tag_size_m = 0.05;
    QVERIFY_THROWS_EXCEPTION(CalibrationError, validate(b));
  }

  void squares_haveInnerCorners() {
    Board charuco = board(BoardType::Charuco, 5, 7);
    charuco.radius_m = 0.0;
    charuco.tag_size_m = 0.03;
    validate(charuco);
    QCOMPARE(charuco.pointCount(), 24);
    QVERIFY((charuco.point_m(7) - Eigen::Vector2d(0.05, 0.05)).norm() < 1e-12);
    Board squares = board(BoardType::Checkerboard, 6, 9);
    QVERIFY_THROWS_EXCEPTION(CalibrationError, validate(squares));  // a radius without circles
    squares.radius_m = 0.0;
    validate(squares);
    QVERIFY(!squares.hasHalfTurnAmbiguity() && squares.pointCount() == 54);
    squares.cols = 8;
    QVERIFY(squares.hasHalfTurnAmbiguity());
  }

  void whatMakesNoBoard_isRefused_data() {
    QTest::addColumn<int>("rows");
    QTest::addColumn<int>("cols");
    QTest::addColumn<double>("spacing_m");
    QTest::addColumn<double>("radius_m");
    QTest::addColumn<QString>("place");
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    QTest::newRow("good") << 11 << 4 << 0.05 << 0.02 << QString();
    QTest::newRow("nearly touching") << 11 << 4 << 0.05 << 0.0353 << QString();
    QTest::newRow("one row") << 1 << 4 << 0.05 << 0.02 << "board";
    QTest::newRow("one column") << 11 << 1 << 0.05 << 0.02 << "board";
    QTest::newRow("too many rows") << 101 << 4 << 0.05 << 0.02 << "board";
    QTest::newRow("too many columns") << 11 << 101 << 0.05 << 0.02 << "board";
    QTest::newRow("no spacing") << 11 << 4 << 0.0 << 0.02 << "board.spacing_m";
    QTest::newRow("spacing is not a number") << 11 << 4 << kNan << 0.02 << "board.spacing_m";
    QTest::newRow("no radius") << 11 << 4 << 0.05 << 0.0 << "board.radius_m";
    QTest::newRow("radius is not a number") << 11 << 4 << 0.05 << kNan << "board.radius_m";
    QTest::newRow("touching") << 11 << 4 << 0.05 << 0.0354 << "board.radius_m";
  }
  void whatMakesNoBoard_isRefused() {
    QFETCH(int, rows);
    QFETCH(int, cols);
    QFETCH(double, spacing_m);
    QFETCH(double, radius_m);
    QFETCH(QString, place);
    Board b = board(BoardType::AsymmetricCircles, rows, cols);
    b.spacing_m = spacing_m;
    b.radius_m = radius_m;
    if (place.isEmpty()) return validate(b);
    try {
      validate(b);
      QFAIL("must throw");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      QCOMPARE(QString::fromStdString(error.place()), place);
    }
  }
};

EVICAL_TEST(TestBoard)
#include "tst_board.moc"
