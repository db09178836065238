#include "core/base/error.h"
#include "core/report/board_drawing.h"
#include "tests/support/rendered_board.h"
#include "tests/support/test_program.h"

#include <opencv2/aruco.hpp>

#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

using namespace evical;

namespace {

constexpr double kMargin_m = 0.01;

Board board() {
  Board b;
  b.rows = 9;
  b.cols = 3;
  b.spacing_m = 0.0301;
  b.radius_m = 0.0105;
  return b;
}

Board boardOf(BoardType type, int rows, int cols, double tag_size_m) {
  Board b;
  b.type = type;
  b.rows = rows;
  b.cols = cols;
  b.spacing_m = 0.04;
  b.radius_m = 0.0;
  b.tag_size_m = tag_size_m;
  return b;
}

int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

}  // namespace

class TestBoardDrawing : public QObject {
  Q_OBJECT

 private slots:
  void svg_hasEveryCircleWhereTheBoardHasIt();
  void svg_ofBrightCirclesPaintsTheBoardDark();
  void pdf_isTrueToScale();
  void pdf_crossReferencesPointAtObjects();
  void drawing_ofATooLargeBoardIsRefused();
  void squares_areThoseThatFindersLookFor_data();
  void squares_areThoseThatFindersLookFor();
  void squares_areDrawnWhereTheyAre();
  void moreTagsThanThereAre_areRefused();
};

void TestBoardDrawing::svg_hasEveryCircleWhereTheBoardHasIt() {
  const Board b = board();
  const std::string svg = boardSvg(b, kMargin_m);
  QCOMPARE(count(svg, "<circle"), b.pointCount());
  std::vector<Eigen::Vector2d> drawn_mm;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) {
    double x = 0.0, y = 0.0, r = 0.0;
    QCOMPARE(std::sscanf(svg.c_str() + at, "<circle cx=\"%lf\" cy=\"%lf\" r=\"%lf\"", &x, &y, &r), 3);
    QVERIFY(std::abs(r - 10.5) < 1e-3);
    drawn_mm.emplace_back(x, y);
  }
  for (int i = 0; i < b.pointCount(); ++i) {
    const Eigen::Vector2d expected_mm = 1e3 * b.point_m(i) + Eigen::Vector2d::Constant(20.5);
    QVERIFY((drawn_mm[static_cast<std::size_t>(i)] - expected_mm).norm() < 2e-3);  // written to a micrometre
  }
}

void TestBoardDrawing::svg_ofBrightCirclesPaintsTheBoardDark() {
  Board b = board();
  QCOMPARE(count(boardSvg(b, kMargin_m), "fill=\"black\"/>"), 0);
  b.circles = CircleShade::Bright;
  const std::string svg = boardSvg(b, kMargin_m);
  QCOMPARE(count(svg, "fill=\"black\"/>"), 1);
  QCOMPARE(count(svg, "<g fill=\"white\">"), 1);
}

void TestBoardDrawing::pdf_isTrueToScale() {
  const Board b = board();
  const std::string pdf = boardPdf(b, kMargin_m);
  double width = 0.0, height = 0.0;
  const std::size_t box = pdf.find("/MediaBox");
  QVERIFY(box != std::string::npos);
  QCOMPARE(std::sscanf(pdf.c_str() + box, "/MediaBox [0 0 %lf %lf]", &width, &height), 2);
  // The widest row is the shifted one: 2 (cols - 1) + 1 spacings, two radii, two margins.
  QVERIFY(std::abs(width - 72.0 / 25.4 * (5 * 30.1 + 2 * 10.5 + 2 * 10.0)) < 1e-3);
  QVERIFY(height > 72.0 / 25.4 * (8 * 30.1 + 2 * 10.5 + 2 * 10.0));
  QCOMPARE(count(pdf, " c f\n"), b.pointCount());
}

void TestBoardDrawing::pdf_crossReferencesPointAtObjects() {
  const std::string pdf = boardPdf(board(), kMargin_m);
  const std::size_t start = pdf.find("startxref\n");
  QVERIFY(start != std::string::npos);
  const auto table = static_cast<std::size_t>(std::stoul(pdf.substr(start + 10)));
  QCOMPARE(pdf.compare(table, 5, "xref\n"), 0);
  const std::size_t entries = pdf.find("65535 f \n", table) + 9;
  for (std::size_t object = 1; object <= 5; ++object) {
    const auto offset = static_cast<std::size_t>(std::stoul(pdf.substr(entries + (object - 1) * 20, 10)));
    QCOMPARE(pdf.compare(offset, 7, std::to_string(object) + " 0 obj"), 0);
  }
}

void TestBoardDrawing::drawing_ofATooLargeBoardIsRefused() {
  Board b = board();
  b.spacing_m = 30.1;  // millimetres taken for metres
  b.radius_m = 10.5;
  QVERIFY_EXCEPTION_THROWN(boardPdf(b, kMargin_m), CalibrationError);
  QVERIFY_EXCEPTION_THROWN(boardSvg(board(), -0.01), CalibrationError);
}

void TestBoardDrawing::squares_areThoseThatFindersLookFor_data() {
  QTest::addColumn<PrintedBoard>("printed");
  QTest::addColumn<TagPrint>("print");
  QTest::newRow("checkerboard") << PrintedBoard{boardOf(BoardType::Checkerboard, 6, 9, 0.0), 2, 0, false}
                                << TagPrint{};
  for (const int border : {1, 2})
    QTest::addRow("border of %d", border)
        << PrintedBoard{boardOf(BoardType::AprilGrid, 5, 6, 0.03), border, 0, false}
        << TagPrint{border, "5x5"};
  QTest::newRow("ChArUco") << PrintedBoard{boardOf(BoardType::Charuco, 6, 9, 0.03), 2, cv::aruco::DICT_4X4_50,
                                           false}
                           << TagPrint{2, "4x4"};
  QTest::newRow("ChArUco, original") << PrintedBoard{boardOf(BoardType::Charuco, 7, 8, 0.025), 2,
                                                     cv::aruco::DICT_ARUCO_ORIGINAL, false}
                                     << TagPrint{2, "original"};
}

// The pattern of rendered_board.h, which finders are tested with, and here painted box over box: the same
// everywhere.
void TestBoardDrawing::squares_areThoseThatFindersLookFor() {
  QFETCH(const PrintedBoard, printed);
  QFETCH(const TagPrint, print);
  const std::vector<PaintedBox> boxes = boardSquares(printed.board, print);
  const auto pattern = patternOf(printed);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> beside(-0.06, 0.06 + printed.board.extent_m().maxCoeff());
  int dark = 0;
  for (int k = 0; k < 20000; ++k) {
    const Eigen::Vector2d at(beside(random), beside(random));
    bool bright = true;
    for (const PaintedBox& box : boxes) {
      const Eigen::Vector2d inside = at - box.corner_m;
      if ((inside.array() >= 0.0).all() && (inside.array() < box.size_m.array()).all()) bright = box.bright;
    }
    QCOMPARE(bright, pattern(at) > 0.5);
    dark += !bright;
  }
  QVERIFY(dark > 2000);
}

void TestBoardDrawing::squares_areDrawnWhereTheyAre() {
  const Board checkerboard = boardOf(BoardType::Checkerboard, 3, 4, 0.0);
  const std::string svg = boardSvg(checkerboard, kMargin_m), pdf = boardPdf(checkerboard, kMargin_m);
  QCOMPARE(count(svg, "<rect x="), 10);  // of 4 x 5 squares
  QVERIFY(svg.find("<rect x=\"10\" y=\"10\" width=\"40\" height=\"40\"/>") != std::string::npos);
  QVERIFY(svg.find("width=\"220mm\"") != std::string::npos);
  QCOMPARE(count(pdf, " re f\n"), 10);
  QVERIFY(svg.find("checkerboard, 3 rows x 4 cols of inner corners, squares 40 mm") != std::string::npos);
}

void TestBoardDrawing::moreTagsThanThereAre_areRefused() {
  QVERIFY_EXCEPTION_THROWN(boardSquares(boardOf(BoardType::AprilGrid, 30, 30, 0.03), {}), CalibrationError);
  QVERIFY_EXCEPTION_THROWN(boardSquares(boardOf(BoardType::Charuco, 60, 60, 0.03), {}), CalibrationError);
  QVERIFY_EXCEPTION_THROWN(boardSquares(boardOf(BoardType::Charuco, 6, 6, 0.03), {2, "8x8"}),
                           CalibrationError);
}

EVICAL_TEST(TestBoardDrawing)
#include "tst_board_drawing.moc"
