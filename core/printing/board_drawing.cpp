#include "core/printing/board_drawing.h"

#include "core/printing/board_sheet.h"

#include <fmt/format.h>

#include <vector>

namespace evical {
namespace {

constexpr double kPointsPerMm = 72.0 / 25.4;  // PDF's unit

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

std::string pdfContent(const BoardSheet& sheet) {
  const auto fromTop = [&](double y_mm) { return kPointsPerMm * (sheet.height_mm - y_mm); };
  std::string content;
  const auto addBox = [&](const SheetBox& box) {
    content += fmt::format("{} g {:.4f} {:.4f} {:.4f} {:.4f} re f\n", box.bright ? 1 : 0,
                           kPointsPerMm * box.x_mm, fromTop(box.y_mm + box.height_mm),
                           kPointsPerMm * box.width_mm, kPointsPerMm * box.height_mm);
  };
  for (const SheetBox& box : sheet.boxes) addBox(box);
  if (!sheet.centres_mm.empty()) content += sheet.bright_circles ? "1 g\n" : "0 g\n";
  for (const Eigen::Vector2d& centre : sheet.centres_mm)
    content += pdfCircle({kPointsPerMm * centre.x(), fromTop(centre.y())}, kPointsPerMm * sheet.radius_mm);
  addBox(sheet.ruler);
  content += fmt::format("BT /F1 {:.2f} Tf {:.4f} {:.4f} Td ({}) Tj ET\n", kPointsPerMm * sheet.text_size_mm,
                         kPointsPerMm * sheet.caption_x_mm, fromTop(sheet.caption_y_mm), sheet.caption);
  return content;
}

std::string svgBox(const SheetBox& box) {
  return fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{}/>\n", shortNumber(box.x_mm),
                     shortNumber(box.y_mm), shortNumber(box.width_mm), shortNumber(box.height_mm),
                     box.bright ? " fill=\"white\"" : "");
}

std::string svgBoard(const BoardSheet& sheet) {
  std::string svg = "<g fill=\"black\">\n";
  for (const SheetBox& box : sheet.boxes) svg += svgBox(box);
  svg += fmt::format("</g>\n<g fill=\"{}\">\n", sheet.bright_circles ? "white" : "black");
  for (const Eigen::Vector2d& centre : sheet.centres_mm)
    svg += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", shortNumber(centre.x()),
                       shortNumber(centre.y()), shortNumber(sheet.radius_mm));
  return svg + "</g>\n";
}

}  // namespace

BoardPicture boardPicture(const Board& board, double margin_m, const TagPrint& print) {
  SheetOptions options;
  options.margin_m = margin_m;
  const BoardSheet sheet = layOut(board, options, print);
  return {sheet.field.width_mm, sheet.field.height_mm,
          fmt::format("<g transform=\"translate({} {})\">\n{}</g>\n", shortNumber(-sheet.field.x_mm),
                      shortNumber(-sheet.field.y_mm), svgBoard(sheet))};
}

std::string boardSvg(const Board& board, const SheetOptions& options, const TagPrint& print) {
  const BoardSheet sheet = layOut(board, options, print);
  std::string svg = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}mm\" "
      "height=\"{1}mm\" viewBox=\"0 0 {0} {1}\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
      shortNumber(sheet.width_mm), shortNumber(sheet.height_mm));
  svg += svgBoard(sheet) + svgBox(sheet.ruler);
  return svg + fmt::format(
                   "<text x=\"{}\" y=\"{}\" font-family=\"Helvetica, Arial, sans-serif\" "
                   "font-size=\"{}\">{}</text>\n</svg>\n",
                   shortNumber(sheet.caption_x_mm), shortNumber(sheet.caption_y_mm),
                   shortNumber(sheet.text_size_mm), sheet.caption);
}

std::string boardPdf(const Board& board, const SheetOptions& options, const TagPrint& print) {
  const BoardSheet sheet = layOut(board, options, print);
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
