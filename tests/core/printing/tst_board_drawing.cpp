#include "core/base/error.h"
#include "core/frames/board_finder.h"
#include "core/printing/board_drawing.h"
#include "tests/support/rendered_board.h"
#include "tests/support/test_program.h"

#include <fmt/format.h>
#include <opencv2/aruco.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

using namespace evical;

namespace {

const SheetOptions kSheet{0.01, {}};

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

cv::Mat decoded(const std::string& png) {
  return cv::imdecode(std::vector<char>(png.begin(), png.end()), cv::IMREAD_GRAYSCALE);
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
  void papers_holdBoardsOfAllTypes_data();
  void papers_holdBoardsOfAllTypes();
  void boardLargerThanItsPaper_isRefusedWithASpacingThatFits();
  void boardThatFits_isAsLargeAsThePaperPermits_data();
  void boardThatFits_isAsLargeAsThePaperPermits();
  void png_isTrueToScale_data();
  void png_isTrueToScale();
  void png_tellsItsResolution();
  void png_ofAbsurdResolution_isRefused();
};

void TestBoardDrawing::svg_hasEveryCircleWhereTheBoardHasIt() {
  const Board b = board();
  const std::string svg = boardSvg(b, kSheet);
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
  QCOMPARE(count(boardSvg(b, kSheet), "<rect x="), 1);  // the ruler
  b.circles = CircleShade::Bright;
  const std::string svg = boardSvg(b, kSheet);
  QCOMPARE(count(svg, "<rect x="), 2);
  QVERIFY(svg.find("<g fill=\"black\">\n<rect x=\"0\" y=\"0\" width=\"191.5\"") != std::string::npos);
  QCOMPARE(count(svg, "<g fill=\"white\">"), 1);
}

void TestBoardDrawing::pdf_isTrueToScale() {
  const Board b = board();
  const std::string pdf = boardPdf(b, kSheet);
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
  const std::string pdf = boardPdf(board(), kSheet);
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
  b.spacing_m = 30.1;  // millimetres given as metres
  b.radius_m = 10.5;
  QVERIFY_THROWS_EXCEPTION(CalibrationError, boardPdf(b, kSheet));
  QVERIFY_THROWS_EXCEPTION(CalibrationError, boardSvg(board(), {-0.01, {}}));
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

// The pattern of rendered_board.h, with which finders are tested, drawn box by box here: both must be equal
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
    const Eigen::Vector2d at{beside(random), beside(random)};
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
  const std::string svg = boardSvg(checkerboard, kSheet), pdf = boardPdf(checkerboard, kSheet);
  QCOMPARE(count(svg, "<rect x="), 10 + 1);  // of 4 x 5 squares, and the ruler
  QVERIFY(svg.find("<rect x=\"10\" y=\"10\" width=\"40\" height=\"40\"/>") != std::string::npos);
  QVERIFY(svg.find("width=\"220mm\"") != std::string::npos);
  QCOMPARE(count(pdf, " re f\n"), 10 + 1);
  QVERIFY(svg.find("checkerboard, 3 rows x 4 cols of inner corners, squares 40 mm") != std::string::npos);
}

void TestBoardDrawing::moreTagsThanThereAre_areRefused() {
  QVERIFY_THROWS_EXCEPTION(CalibrationError, boardSquares(boardOf(BoardType::AprilGrid, 30, 30, 0.03), {}));
  QVERIFY_THROWS_EXCEPTION(CalibrationError, boardSquares(boardOf(BoardType::Charuco, 60, 60, 0.03), {}));
  QVERIFY_THROWS_EXCEPTION(CalibrationError,
                           boardSquares(boardOf(BoardType::Charuco, 6, 6, 0.03), {2, "8x8"}));
}

// The largest board that fits with a margin of 1 cm, by the width of a board of 5 to 6 spacings.
void TestBoardDrawing::papers_holdBoardsOfAllTypes_data() {
  QTest::addColumn<Board>("printed");
  QTest::addColumn<Paper>("paper");
  for (const Paper& paper : papers())
    for (std::size_t type = 0; type < kPatternNames.size(); ++type) {
      Board printed = boardOf(static_cast<BoardType>(type), 7, 4, 0.0);
      printed.spacing_m = 1e-3 * (paper.short_mm - 20.0) / 9.0;
      if (printed.hasTags()) printed.tag_size_m = 0.7 * printed.spacing_m;
      if (printed.hasCircles()) printed.radius_m = 0.4 * printed.spacing_m;
      QTest::addRow("%s on %s", kPatternNames[type], paper.name.c_str()) << printed << paper;
    }
}

void TestBoardDrawing::papers_holdBoardsOfAllTypes() {
  QFETCH(const Board, printed);
  QFETCH(const Paper, paper);
  const SheetOptions sheet{0.01, paper};
  const std::string svg = boardSvg(printed, sheet), pdf = boardPdf(printed, sheet);
  double width = 0.0, height = 0.0;
  QCOMPARE(std::sscanf(svg.c_str() + svg.find("viewBox"), "viewBox=\"0 0 %lf %lf\"", &width, &height), 2);
  QCOMPARE(std::min(width, height), paper.short_mm);
  QCOMPARE(std::max(width, height), paper.long_mm);
  QCOMPARE(std::sscanf(pdf.c_str() + pdf.find("/MediaBox"), "/MediaBox [0 0 %lf", &width), 1);
  QVERIFY(std::abs(width / 72.0 * 25.4 - paper.short_mm) < 1e-3);
  QVERIFY(svg.find("width=\"100\" height=\"0.25\"/>") != std::string::npos);  // the ruler
  QVERIFY(pdf.find(fmt::format("{:.4f} {:.4f} re f\nBT", 100.0 * 72.0 / 25.4, 0.25 * 72.0 / 25.4)) !=
          std::string::npos);
  const cv::Mat png = decoded(boardPng(printed, 40.0, sheet));
  QCOMPARE(png.cols, qRound(paper.short_mm / 25.4 * 40.0));
  QCOMPARE(png.rows, qRound(paper.long_mm / 25.4 * 40.0));
}

void TestBoardDrawing::boardLargerThanItsPaper_isRefusedWithASpacingThatFits() {
  Board b = boardOf(BoardType::Checkerboard, 6, 9, 0.0);
  const SheetOptions sheet{0.01, papers().front()};  // A4
  try {
    boardPdf(b, sheet);
    QFAIL("drawn");
  } catch (const CalibrationError& error) {
    double fits_mm = 0.0;
    const std::string advice = error.advice();
    QCOMPARE(std::sscanf(advice.c_str() + advice.find("a spacing of"), "a spacing of %lf", &fits_mm), 1);
    b.spacing_m = 1e-3 * fits_mm;
    QVERIFY(std::abs(boardThatFits(b, sheet, {})->spacing_m - b.spacing_m) < 1e-9);
    boardPdf(b, sheet);
    QVERIFY(fitsSheet(b, sheet));
    b.spacing_m += 2e-4;
    QVERIFY(!fitsSheet(b, sheet));
    QVERIFY_THROWS_EXCEPTION(CalibrationError, boardPdf(b, sheet));
  }
}

void TestBoardDrawing::boardThatFits_isAsLargeAsThePaperPermits_data() {
  papers_holdBoardsOfAllTypes_data();
}

void TestBoardDrawing::boardThatFits_isAsLargeAsThePaperPermits() {
  QFETCH(Board, printed);
  QFETCH(const Paper, paper);
  const SheetOptions sheet{0.01, paper};
  printed.spacing_m *= 20.0;
  printed.radius_m *= 20.0;
  printed.tag_size_m *= 20.0;
  QVERIFY(!fitsSheet(printed, sheet));
  Board fitting = *boardThatFits(printed, sheet, {});
  QVERIFY(fitsSheet(fitting, sheet));
  QVERIFY(std::abs(fitting.radius_m * printed.spacing_m - printed.radius_m * fitting.spacing_m) < 1e-12);
  QVERIFY(std::abs(fitting.tag_size_m * printed.spacing_m - printed.tag_size_m * fitting.spacing_m) < 1e-12);
  const double larger = 1.0 + 2e-4 / fitting.spacing_m;
  fitting.spacing_m *= larger;
  fitting.radius_m *= larger;
  fitting.tag_size_m *= larger;
  QVERIFY(!fitsSheet(fitting, sheet));
  QVERIFY(!boardThatFits(printed, {1.0, paper}, {}));  // margins of 1 m leave no space
}

void TestBoardDrawing::png_isTrueToScale_data() {
  QTest::addColumn<Board>("printed");
  QTest::newRow("circles") << board();
  Board bright = board();
  bright.circles = CircleShade::Bright;
  QTest::newRow("bright circles") << bright;
  QTest::newRow("checkerboard") << boardOf(BoardType::Checkerboard, 5, 6, 0.0);
  QTest::newRow("AprilGrid") << boardOf(BoardType::AprilGrid, 3, 4, 0.03);
  QTest::newRow("ChArUco") << boardOf(BoardType::Charuco, 5, 6, 0.03);
}

// The finder for frames finds every point at its position on the sheet, after blur as by a lens, within the
// finder's error for edges this sharp; and the ruler is 100 mm long.
void TestBoardDrawing::png_isTrueToScale() {
  QFETCH(const Board, printed);
  constexpr double kDpi = 96.0, kPxPerMm = kDpi / 25.4;
  const cv::Mat png = decoded(boardPng(printed, kDpi, kSheet));
  cv::Mat seen;
  cv::GaussianBlur(png, seen, {}, 1.0);
  GrayImage image{{seen.cols, seen.rows}, {}};
  image.pixels.assign(seen.datastart, seen.dataend);
  const FoundPoints found = BoardFinder(printed, {}).find(image);
  QCOMPARE(static_cast<int>(found.size()), printed.pointCount());
  double furthest_px = 0.0;
  for (const FoundPoint& point : found) {
    const Eigen::Vector2d from_first_px = point.at_px - found.front().at_px;
    const Eigen::Vector2d from_first_m = printed.point_m(point.point) - printed.point_m(found.front().point);
    furthest_px = std::max(furthest_px, (from_first_px - 1e3 * kPxPerMm * from_first_m).norm());
  }
  QVERIFY2(furthest_px < 0.06, qPrintable(QString::number(furthest_px)));
  const cv::Mat ruler =
      255 - png.rowRange(png.rows - qRound(16.0 * kPxPerMm), png.rows - qRound(12.0 * kPxPerMm));
  cv::Mat columns;
  cv::reduce(ruler, columns, 0, cv::REDUCE_SUM, CV_32S);
  QVERIFY(std::abs(cv::countNonZero(columns) - 100.0 * kPxPerMm) < 2.0);
  QVERIFY(std::abs(cv::sum(ruler)[0] / 255.0 - 100.0 * 0.25 * kPxPerMm * kPxPerMm) < 5.0);
}

void TestBoardDrawing::png_tellsItsResolution() {
  const std::string png = boardPng(board(), 300.0, kSheet);
  const std::size_t chunk = png.find("pHYs");
  QVERIFY(chunk != std::string::npos);
  QCOMPARE(png.substr(chunk + 4, 9), std::string("\0\0\x2E\x23\0\0\x2E\x23\1", 9));  // 11811 per metre
  QCOMPARE(decoded(png).cols, qRound((5 * 30.1 + 2 * 10.5 + 2 * 10.0) / 25.4 * 300.0));
}

void TestBoardDrawing::png_ofAbsurdResolution_isRefused() {
  for (const double dpi : {0.0, -300.0, 1e5, std::nan("")})
    QVERIFY_THROWS_EXCEPTION(CalibrationError, boardPng(board(), dpi, kSheet));
}

EVICAL_TEST(TestBoardDrawing)
#include "tst_board_drawing.moc"
