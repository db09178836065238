#include "core/base/error.h"
#include "core/report/board_drawing.h"
#include "tests/support/test_program.h"

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

using namespace evical;

namespace {

constexpr double kMargin_m = 0.01;

CircleBoard board() {
  CircleBoard b;
  b.rows = 9;
  b.cols = 3;
  b.spacing_m = 0.0301;
  b.radius_m = 0.0105;
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
};

void TestBoardDrawing::svg_hasEveryCircleWhereTheBoardHasIt() {
  const CircleBoard b = board();
  const std::string svg = boardSvg(b, kMargin_m);
  QCOMPARE(count(svg, "<circle"), b.circleCount());
  std::vector<Eigen::Vector2d> drawn_mm;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) {
    double x = 0.0, y = 0.0, r = 0.0;
    QCOMPARE(std::sscanf(svg.c_str() + at, "<circle cx=\"%lf\" cy=\"%lf\" r=\"%lf\"", &x, &y, &r), 3);
    QVERIFY(std::abs(r - 10.5) < 1e-3);
    drawn_mm.emplace_back(x, y);
  }
  for (int i = 0; i < b.circleCount(); ++i) {
    const Eigen::Vector2d expected_mm = 1e3 * b.centre_m(i) + Eigen::Vector2d::Constant(20.5);
    QVERIFY((drawn_mm[static_cast<std::size_t>(i)] - expected_mm).norm() < 2e-3);  // written to a micrometre
  }
}

void TestBoardDrawing::svg_ofBrightCirclesPaintsTheBoardDark() {
  CircleBoard b = board();
  QCOMPARE(count(boardSvg(b, kMargin_m), "fill=\"black\"/>"), 0);
  b.circles = CircleShade::Bright;
  const std::string svg = boardSvg(b, kMargin_m);
  QCOMPARE(count(svg, "fill=\"black\"/>"), 1);
  QCOMPARE(count(svg, "<g fill=\"white\">"), 1);
}

void TestBoardDrawing::pdf_isTrueToScale() {
  const CircleBoard b = board();
  const std::string pdf = boardPdf(b, kMargin_m);
  double width = 0.0, height = 0.0;
  const std::size_t box = pdf.find("/MediaBox");
  QVERIFY(box != std::string::npos);
  QCOMPARE(std::sscanf(pdf.c_str() + box, "/MediaBox [0 0 %lf %lf]", &width, &height), 2);
  // The widest row is the shifted one: 2 (cols - 1) + 1 spacings, two radii, two margins.
  QVERIFY(std::abs(width - 72.0 / 25.4 * (5 * 30.1 + 2 * 10.5 + 2 * 10.0)) < 1e-3);
  QVERIFY(height > 72.0 / 25.4 * (8 * 30.1 + 2 * 10.5 + 2 * 10.0));
  QCOMPARE(count(pdf, " c f\n"), b.circleCount());
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
  CircleBoard b = board();
  b.spacing_m = 30.1;  // millimetres taken for metres
  b.radius_m = 10.5;
  QVERIFY_EXCEPTION_THROWN(boardPdf(b, kMargin_m), CalibrationError);
  QVERIFY_EXCEPTION_THROWN(boardSvg(board(), -0.01), CalibrationError);
}

EVICAL_TEST(TestBoardDrawing)
#include "tst_board_drawing.moc"
