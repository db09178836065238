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

struct Sheet {
  double width_mm = 0.0, board_height_mm = 0.0, height_mm = 0.0;
  double margin_mm = 0.0, radius_mm = 0.0;
  std::vector<Eigen::Vector2d> centres_mm;  // from the top left corner, y down
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

Sheet layOut(const CircleBoard& board, double margin_m) {
  validate(board);
  if (!(margin_m >= 0.0)) throw badInput("margin", "is below 0", "Give a margin in metres");
  Sheet sheet;
  sheet.margin_mm = 1e3 * margin_m;
  sheet.radius_mm = 1e3 * board.radius_m;
  sheet.bright_circles = board.circles == CircleShade::Bright;
  const double border_mm = sheet.margin_mm + sheet.radius_mm;
  Eigen::Vector2d largest_mm = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& centre_m : circleCentres_m(board)) {
    sheet.centres_mm.emplace_back(1e3 * centre_m + Eigen::Vector2d::Constant(border_mm));
    largest_mm = largest_mm.cwiseMax(1e3 * centre_m);
  }
  sheet.width_mm = largest_mm.x() + 2.0 * border_mm;
  sheet.board_height_mm = largest_mm.y() + 2.0 * border_mm;
  sheet.height_mm = sheet.board_height_mm + kFooterHeight_mm;
  if (sheet.width_mm > kLargestSheet_mm || sheet.height_mm > kLargestSheet_mm)
    throw badInput("board",
                   fmt::format("needs a sheet of {:.1f} m x {:.1f} m, and 5 m is the most",
                               1e-3 * sheet.width_mm, 1e-3 * sheet.height_mm),
                   "Check that spacing and radius are in metres");
  sheet.caption = fmt::format(
      "Evical board: {}, {} rows x {} cols, spacing {} mm, radius {} mm, {} circles. Print at 100 %; the "
      "line is {} mm.",
      board.type == BoardType::AsymmetricCircles ? "asymmetric" : "symmetric", board.rows, board.cols,
      number(1e3 * board.spacing_m), number(sheet.radius_mm), sheet.bright_circles ? "bright" : "dark",
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
  const double ruler_y = fromTop(sheet.board_height_mm + 4.0), left = kPointsPerMm * 5.0;
  content += fmt::format("0 g 0 G 0.7 w {0:.4f} {1:.4f} m {2:.4f} {1:.4f} l S\n", left, ruler_y,
                         left + kPointsPerMm * kRulerLength_mm);
  content += fmt::format("BT /F1 {:.2f} Tf {:.4f} {:.4f} Td ({}) Tj ET\n", kPointsPerMm * kTextSize_mm, left,
                         fromTop(sheet.board_height_mm + 10.0), sheet.caption);
  return content;
}

}  // namespace

std::string boardSvg(const CircleBoard& board, double margin_m) {
  const Sheet sheet = layOut(board, margin_m);
  const std::string width = number(sheet.width_mm), height = number(sheet.height_mm);
  std::string svg = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}mm\" "
      "height=\"{1}mm\" viewBox=\"0 0 {0} {1}\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
      width, height);
  if (sheet.bright_circles)
    svg += fmt::format("<rect width=\"{}\" height=\"{}\" fill=\"black\"/>\n", width,
                       number(sheet.board_height_mm));
  svg += fmt::format("<g fill=\"{}\">\n", sheet.bright_circles ? "white" : "black");
  for (const Eigen::Vector2d& centre : sheet.centres_mm)
    svg += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", number(centre.x()), number(centre.y()),
                       number(sheet.radius_mm));
  svg += fmt::format("</g>\n<path d=\"M 5 {} h {}\" stroke=\"black\" stroke-width=\"0.25\"/>\n",
                     number(sheet.board_height_mm + 4.0), number(kRulerLength_mm));
  return svg + fmt::format(
                   "<text x=\"5\" y=\"{}\" font-family=\"Helvetica, Arial, sans-serif\" "
                   "font-size=\"{}\">{}</text>\n"
                   "</svg>\n",
                   number(sheet.board_height_mm + 10.0), number(kTextSize_mm), sheet.caption);
}

std::string boardPdf(const CircleBoard& board, double margin_m) {
  const Sheet sheet = layOut(board, margin_m);
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
