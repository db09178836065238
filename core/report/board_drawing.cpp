#include "core/report/board_drawing.h"

#include "core/base/error.h"

#include <fmt/format.h>

#include <vector>

namespace evical {
namespace {

constexpr double kFooterHeight_mm = 14.0;  // ruler and caption below the board
constexpr double kRulerLength_mm = 100.0;
constexpr double kTextSize_mm = 3.0;
constexpr double kLargestSheet_mm = 5080.0;   // 14400 units, PDF 1.7 annex C
constexpr double kPointsPerMm = 72.0 / 25.4;  // PDF's unit

struct Box {
  double x_mm = 0.0, y_mm = 0.0, width_mm = 0.0, height_mm = 0.0;
  bool bright = false;
};

struct Sheet {
  double width_mm = 0.0, board_height_mm = 0.0, height_mm = 0.0;
  double margin_mm = 0.0, radius_mm = 0.0;
  std::vector<Eigen::Vector2d> centres_mm;  // from the top left corner, y down
  std::vector<Box> boxes;                   // painted in this order
  bool bright_circles = false;
  std::string caption;
};

// Shortest text that is exact to a micrometre: 50, 49.5, 0.125.
std::string number(double value) {
  std::string text = fmt::format("{:.3f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

void placeCircles(const Board& board, Sheet& sheet) {
  sheet.radius_mm = 1e3 * board.radius_m;
  sheet.bright_circles = board.circles == CircleShade::Bright;
  const double border_mm = sheet.margin_mm + sheet.radius_mm;
  Eigen::Vector2d largest_mm = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& centre_m : boardPoints_m(board)) {
    sheet.centres_mm.emplace_back(1e3 * centre_m + Eigen::Vector2d::Constant(border_mm));
    largest_mm = largest_mm.cwiseMax(1e3 * centre_m);
  }
  sheet.width_mm = largest_mm.x() + 2.0 * border_mm;
  sheet.board_height_mm = largest_mm.y() + 2.0 * border_mm;
}

void placeSquares(const Board& board, const TagPrint& print, Sheet& sheet) {
  const std::vector<PaintedBox> boxes = boardSquares(board, print);
  Eigen::Vector2d first_m = boxes.front().corner_m, last_m = first_m;
  for (const PaintedBox& box : boxes) {
    first_m = first_m.cwiseMin(box.corner_m);
    last_m = last_m.cwiseMax(box.corner_m + box.size_m);
  }
  for (const PaintedBox& box : boxes) {
    const Eigen::Vector2d at_mm = 1e3 * (box.corner_m - first_m) + Eigen::Vector2d::Constant(sheet.margin_mm);
    sheet.boxes.push_back({at_mm.x(), at_mm.y(), 1e3 * box.size_m.x(), 1e3 * box.size_m.y(), box.bright});
  }
  sheet.width_mm = 1e3 * (last_m - first_m).x() + 2.0 * sheet.margin_mm;
  sheet.board_height_mm = 1e3 * (last_m - first_m).y() + 2.0 * sheet.margin_mm;
}

std::string describe(const Board& board, const TagPrint& print) {
  const std::string spacing = number(1e3 * board.spacing_m), tag = number(1e3 * board.tag_size_m);
  switch (board.type) {
    case BoardType::Checkerboard:
      return fmt::format("checkerboard, {} rows x {} cols of inner corners, squares {} mm", board.rows,
                         board.cols, spacing);
    case BoardType::AprilGrid:
      return fmt::format(
          "aprilgrid, {} rows x {} cols of tags (36h11), border {} bits, tag {} mm, from tag to tag {} mm",
          board.rows, board.cols, print.border_bits, tag, spacing);
    case BoardType::Charuco:
      return fmt::format("charuco, {} rows x {} cols of squares, {} mm, markers {} mm, {}", board.rows,
                         board.cols, spacing, tag, print.markers);
    default:
      return fmt::format("{}, {} rows x {} cols, spacing {} mm, radius {} mm, {} circles",
                         board.type == BoardType::AsymmetricCircles ? "asymmetric" : "symmetric", board.rows,
                         board.cols, spacing, number(1e3 * board.radius_m),
                         board.circles == CircleShade::Bright ? "bright" : "dark");
  }
}

Sheet layOut(const Board& board, double margin_m, const TagPrint& print) {
  validate(board);
  if (!(margin_m >= 0.0)) throw badInput("margin", "is below 0", "Give a margin in metres");
  Sheet sheet;
  sheet.margin_mm = 1e3 * margin_m;
  if (board.hasCircles())
    placeCircles(board, sheet);
  else
    placeSquares(board, print, sheet);
  sheet.height_mm = sheet.board_height_mm + kFooterHeight_mm;
  if (sheet.width_mm > kLargestSheet_mm || sheet.height_mm > kLargestSheet_mm)
    throw badInput("board",
                   fmt::format("needs a sheet of {:.1f} m x {:.1f} m, and 5 m is the most",
                               1e-3 * sheet.width_mm, 1e-3 * sheet.height_mm),
                   board.hasCircles() ? "Check that spacing and radius are in metres"
                                      : "Check that spacing and size are in metres");
  sheet.caption = fmt::format("Evical board: {}. Print at 100 %; the line is {} mm.", describe(board, print),
                              number(kRulerLength_mm));
  return sheet;
}

// A circle of four cubic curves, in points; error 0.03 % of the radius.
std::string pdfCircle(const Eigen::Vector2d& centre, double radius) {
  const double k = 0.5522847498 * radius;
  const double x = centre.x(), y = centre.y(), r = radius;
  return fmt::format(
      "{:.4f} {:.4f} m {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} c {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} "
      "c "
      "{:.4f} {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} c {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} c f\n",
      x + r, y, x + r, y + k, x + k, y + r, x, y + r, x - k, y + r, x - r, y + k, x - r, y, x - r, y - k,
      x - k, y - r, x, y - r, x + k, y - r, x + r, y - k, x + r, y);
}

std::string pdfContent(const Sheet& sheet) {
  const auto fromTop = [&](double y_mm) { return kPointsPerMm * (sheet.height_mm - y_mm); };
  std::string content;
  if (sheet.bright_circles)
    content += fmt::format("0 g 0 {:.4f} {:.4f} {:.4f} re f 1 g\n", fromTop(sheet.board_height_mm),
                           kPointsPerMm * sheet.width_mm, kPointsPerMm * sheet.board_height_mm);
  for (const Eigen::Vector2d& centre : sheet.centres_mm)
    content += pdfCircle({kPointsPerMm * centre.x(), fromTop(centre.y())}, kPointsPerMm * sheet.radius_mm);
  for (const Box& box : sheet.boxes)
    content += fmt::format("{} g {:.4f} {:.4f} {:.4f} {:.4f} re f\n", box.bright ? 1 : 0,
                           kPointsPerMm * box.x_mm, fromTop(box.y_mm + box.height_mm),
                           kPointsPerMm * box.width_mm, kPointsPerMm * box.height_mm);
  const double ruler_y = fromTop(sheet.board_height_mm + 4.0), left = kPointsPerMm * 5.0;
  content += fmt::format("0 g 0 G 0.7 w {0:.4f} {1:.4f} m {2:.4f} {1:.4f} l S\n", left, ruler_y,
                         left + kPointsPerMm * kRulerLength_mm);
  content += fmt::format("BT /F1 {:.2f} Tf {:.4f} {:.4f} Td ({}) Tj ET\n", kPointsPerMm * kTextSize_mm, left,
                         fromTop(sheet.board_height_mm + 10.0), sheet.caption);
  return content;
}

std::string svgElements(const Sheet& sheet) {
  std::string svg;
  if (sheet.bright_circles)
    svg += fmt::format("<rect width=\"{}\" height=\"{}\" fill=\"black\"/>\n", number(sheet.width_mm),
                       number(sheet.board_height_mm));
  svg += fmt::format("<g fill=\"{}\">\n", sheet.bright_circles ? "white" : "black");
  for (const Eigen::Vector2d& centre : sheet.centres_mm)
    svg += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", number(centre.x()), number(centre.y()),
                       number(sheet.radius_mm));
  for (const Box& box : sheet.boxes)
    svg += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{}/>\n", number(box.x_mm),
                       number(box.y_mm), number(box.width_mm), number(box.height_mm),
                       box.bright ? " fill=\"white\"" : "");
  return svg + "</g>\n";
}

}  // namespace

BoardPicture boardPicture(const Board& board, double margin_m, const TagPrint& print) {
  const Sheet sheet = layOut(board, margin_m, print);
  return {sheet.width_mm, sheet.board_height_mm, svgElements(sheet)};
}

std::string boardSvg(const Board& board, double margin_m, const TagPrint& print) {
  const Sheet sheet = layOut(board, margin_m, print);
  const std::string width = number(sheet.width_mm), height = number(sheet.height_mm);
  std::string svg = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}mm\" "
      "height=\"{1}mm\" viewBox=\"0 0 {0} {1}\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
      width, height);
  svg += svgElements(sheet);
  svg += fmt::format("<path d=\"M 5 {} h {}\" stroke=\"black\" stroke-width=\"0.25\"/>\n",
                     number(sheet.board_height_mm + 4.0), number(kRulerLength_mm));
  return svg + fmt::format(
                   "<text x=\"5\" y=\"{}\" font-family=\"Helvetica, Arial, sans-serif\" "
                   "font-size=\"{}\">{}</text>\n"
                   "</svg>\n",
                   number(sheet.board_height_mm + 10.0), number(kTextSize_mm), sheet.caption);
}

std::string boardPdf(const Board& board, double margin_m, const TagPrint& print) {
  const Sheet sheet = layOut(board, margin_m, print);
  const std::string content = pdfContent(sheet);
  const std::vector<std::string> objects = {
      "<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
      "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
      fmt::format("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:.4f} {:.4f}] /Contents 4 0 R "
                  "/Resources << /Font << /F1 5 0 R >> >> >>",
                  kPointsPerMm * sheet.width_mm, kPointsPerMm * sheet.height_mm),
      fmt::format("<< /Length {} >>\nstream\n{}endstream", content.size(), content),
      "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>"};
  std::string pdf = "%PDF-1.7\n", offsets;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    offsets += fmt::format("{:010} 00000 n \n", pdf.size());
    pdf += fmt::format("{} 0 obj\n{}\nendobj\n", i + 1, objects[i]);
  }
  return pdf + fmt::format(
                   "xref\n0 {0}\n0000000000 65535 f \n{1}trailer\n<< /Size {0} /Root 1 0 R "
                   ">>\nstartxref\n{2}\n%%EOF\n",
                   objects.size() + 1, offsets, pdf.size());
}

}  // namespace evical
