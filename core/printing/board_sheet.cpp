#include "core/printing/board_sheet.h"

#include "core/base/error.h"
#include "core/format/gray_png.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace evical {
namespace {

constexpr double kMmPerInch = 25.4;

// Renders row by row. Each row of pixels is divided into bands, so that boxes begin and end only at a band's
// edges.
class SheetRaster {
 public:
  SheetRaster(const BoardSheet& sheet, double resolution_dpi)
      : sheet_(sheet),
        px_per_mm_(resolution_dpi / kMmPerInch),
        width_px_(static_cast<int>(std::lround(sheet.width_mm * px_per_mm_))),
        height_px_(static_cast<int>(std::lround(sheet.height_mm * px_per_mm_))),
        band_(static_cast<std::size_t>(width_px_)),
        sum_(band_.size()) {
    letter();
  }

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }

  void paint(int row, std::vector<std::uint8_t>& shades) {
    std::fill(sum_.begin(), sum_.end(), 0.0F);
    const std::vector<double> edges = edgesWithin(row);
    for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
      paintBand(0.5 * (edges[k] + edges[k + 1]) / px_per_mm_);
      const auto share = static_cast<float>(edges[k + 1] - edges[k]);
      for (std::size_t x = 0; x < sum_.size(); ++x) sum_[x] += share * band_[x];
    }
    shades.resize(sum_.size());
    const int text_row = row - text_top_px_;
    const bool text = text_row >= 0 && text_row < text_.rows;
    for (std::size_t x = 0; x < sum_.size(); ++x) {
      shades[x] = static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(sum_[x], 0.0F, 1.0F)));
      if (text) shades[x] = std::min(shades[x], text_.at<std::uint8_t>(text_row, static_cast<int>(x)));
    }
  }

 private:
  // Band edges in pixels, in order. Circles are sampled at the centres of eight bands.
  std::vector<double> edgesWithin(int row) const {
    constexpr int kBandsOfCircle = 8;
    std::vector<double> edges = {static_cast<double>(row), row + 1.0};
    const auto add = [&](double y_mm) {
      const double y = y_mm * px_per_mm_;
      if (y > row && y < row + 1.0) edges.push_back(y);
    };
    for (const SheetBox& box : sheet_.boxes) {
      add(box.y_mm);
      add(box.y_mm + box.height_mm);
    }
    add(sheet_.ruler.y_mm);
    add(sheet_.ruler.y_mm + sheet_.ruler.height_mm);
    const double middle_mm = (row + 0.5) / px_per_mm_, reach_mm = sheet_.radius_mm + 1.0 / px_per_mm_;
    const bool circles =
        std::any_of(sheet_.centres_mm.begin(), sheet_.centres_mm.end(),
                    [&](const auto& centre) { return std::abs(centre.y() - middle_mm) < reach_mm; });
    for (int k = 1; circles && k < kBandsOfCircle; ++k)
      edges.push_back(row + static_cast<double>(k) / kBandsOfCircle);
    std::sort(edges.begin(), edges.end());
    return edges;
  }

  void paintBand(double y_mm) {
    std::fill(band_.begin(), band_.end(), 1.0F);
    const auto paintBox = [&](const SheetBox& box) {
      if (y_mm > box.y_mm && y_mm < box.y_mm + box.height_mm)
        paintSpan(box.x_mm, box.x_mm + box.width_mm, box.bright ? 1.0F : 0.0F);
    };
    for (const SheetBox& box : sheet_.boxes) paintBox(box);
    paintBox(sheet_.ruler);
    for (const Eigen::Vector2d& centre : sheet_.centres_mm) {
      const double squared = sheet_.radius_mm * sheet_.radius_mm - std::pow(y_mm - centre.y(), 2);
      if (squared <= 0.0) continue;
      const double half_mm = std::sqrt(squared);
      paintSpan(centre.x() - half_mm, centre.x() + half_mm, sheet_.bright_circles ? 1.0F : 0.0F);
    }
  }

  void paintSpan(double begin_mm, double end_mm, float shade) {
    const double begin = std::clamp(begin_mm * px_per_mm_, 0.0, static_cast<double>(width_px_)),
                 end = std::clamp(end_mm * px_per_mm_, 0.0, static_cast<double>(width_px_));
    for (auto x = static_cast<std::size_t>(begin); static_cast<double>(x) < end; ++x) {
      const auto covered = static_cast<float>(std::min(end, static_cast<double>(x) + 1.0) -
                                              std::max(begin, static_cast<double>(x)));
      band_[x] += covered * (shade - band_[x]);
    }
  }

  // Draws the caption in a separate strip.
  void letter() {
    constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
    constexpr double kCapital = 21.0;  // height of a capital letter in pixels at scale 1
    const double letter_px = 0.7 * sheet_.text_size_mm * px_per_mm_;
    const int thickness = std::max(1, static_cast<int>(std::lround(0.12 * letter_px)));
    const auto above = static_cast<int>(std::ceil(2.0 * letter_px)), below = above;
    text_top_px_ = static_cast<int>(std::lround(sheet_.caption_y_mm * px_per_mm_)) - above;
    text_ = cv::Mat(above + below, width_px_, CV_8UC1, cv::Scalar(255));
    const cv::Point first(static_cast<int>(std::lround(sheet_.caption_x_mm * px_per_mm_)), above);
    const cv::Size size = cv::getTextSize(sheet_.caption, kFont, 1.0, thickness, nullptr);
    const double scale = std::min(letter_px / kCapital, 0.95 * (width_px_ - 2.0 * first.x) / size.width);
    cv::putText(text_, sheet_.caption, first, kFont, scale, cv::Scalar(0), thickness, cv::LINE_AA);
  }

  const BoardSheet& sheet_;
  double px_per_mm_;
  int width_px_, height_px_;
  std::vector<float> band_, sum_;
  cv::Mat text_;
  int text_top_px_ = 0;
};

}  // namespace

std::string boardPng(const Board& board, double resolution_dpi, const SheetOptions& options,
                     const TagPrint& print) {
  constexpr double kMin_dpi = 10.0, kMax_dpi = 4800.0, kMaxPixels = 2e9;
  if (!(resolution_dpi >= kMin_dpi && resolution_dpi <= kMax_dpi))
    throw badInput("dpi", fmt::format("must be in {}..{}", kMin_dpi, kMax_dpi),
                   "Use 300 or 600, as printers do");
  const BoardSheet sheet = layOut(board, options, print);
  SheetRaster raster(sheet, resolution_dpi);
  const double pixels = static_cast<double>(raster.width_px()) * raster.height_px();
  if (pixels > kMaxPixels)
    throw badInput("dpi",
                   fmt::format("gives an image of {} x {} pixels, which is too large", raster.width_px(),
                               raster.height_px()),
                   "Use a lower resolution, or PDF or SVG, which have no pixels");
  GrayPng png(raster.width_px(), raster.height_px(), resolution_dpi);
  std::vector<std::uint8_t> row;
  for (int y = 0; y < raster.height_px(); ++y) {
    raster.paint(y, row);
    png.addRow(row);
  }
  return png.finish();
}

namespace {

constexpr double kFooterHeight_mm = 18.0;  // ruler and caption below the board
constexpr double kRulerLength_mm = 100.0, kRulerWidth_mm = 0.25;
constexpr double kFooterIndent_mm = 10.0, kRulerBelow_mm = 4.0, kCaptionBelow_mm = 10.0;
constexpr double kLargestText_mm = 3.0, kLetterWidth = 0.6;  // upper bound, relative to the text size
constexpr double kLargestSheet_mm = 5080.0;                  // 14400 units, PDF 1.7 annex C

// The pattern, from its own top left corner.
struct Pattern {
  Eigen::Vector2d size_mm = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> centres_mm;
  std::vector<SheetBox> boxes;
};

Pattern circlesOf(const Board& board) {
  Pattern pattern;
  const double radius_mm = 1e3 * board.radius_m;
  for (const Eigen::Vector2d& centre_m : boardPoints_m(board))
    pattern.centres_mm.emplace_back(1e3 * centre_m + Eigen::Vector2d::Constant(radius_mm));
  pattern.size_mm = 1e3 * board.extent_m() + Eigen::Vector2d::Constant(2.0 * radius_mm);
  return pattern;
}

Pattern squaresOf(const Board& board, const TagPrint& print) {
  Pattern pattern;
  const Eigen::Vector2d first_m = Eigen::Vector2d::Constant(-board.printBeyond_m());
  for (const PaintedBox& box : boardSquares(board, print)) {
    const Eigen::Vector2d at_mm = 1e3 * (box.corner_m - first_m);
    pattern.boxes.push_back({at_mm.x(), at_mm.y(), 1e3 * box.size_m.x(), 1e3 * box.size_m.y(), box.bright});
  }
  pattern.size_mm = 1e3 * (board.extent_m() - 2.0 * first_m);
  return pattern;
}

std::string describe(const Board& board, const TagPrint& print) {
  const std::string spacing = shortNumber(1e3 * board.spacing_m), tag = shortNumber(1e3 * board.tag_size_m);
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
                         board.cols, spacing, shortNumber(1e3 * board.radius_m),
                         board.circles == CircleShade::Bright ? "bright" : "dark");
  }
}

// Size that the board needs, at least the width of the ruler.
Eigen::Vector2d ownSize_mm(const Board& board, const Eigen::Vector2d& needed_mm) {
  const Eigen::Vector2d size_mm =
      needed_mm.cwiseMax(Eigen::Vector2d(kRulerLength_mm + 2.0 * kFooterIndent_mm, 0.0));
  if (size_mm.maxCoeff() > kLargestSheet_mm)
    throw badInput("board",
                   fmt::format("needs a sheet of {:.1f} m x {:.1f} m; the maximum is 5 m", 1e-3 * size_mm.x(),
                               1e-3 * size_mm.y()),
                   board.hasCircles() ? "Check that spacing and radius are in metres"
                                      : "Check that spacing and size are in metres");
  return size_mm;
}

bool isUsable(const Board& board) {
  try {
    validate(board);
    return true;
  } catch (const CalibrationError&) {
    return false;
  }
}

// Contents of a sheet: the pattern, and the margins and the footer around it.
struct SheetNeeds {
  Pattern pattern;
  Eigen::Vector2d field_mm, whole_mm;  // pattern with margins; with the footer, too
};

SheetNeeds needsOf(const Board& board, const SheetOptions& options, const TagPrint& print) {
  SheetNeeds needs;
  needs.pattern = board.hasCircles() ? circlesOf(board) : squaresOf(board, print);
  needs.field_mm = needs.pattern.size_mm + Eigen::Vector2d::Constant(2e3 * options.margin_m);
  needs.whole_mm = needs.field_mm + Eigen::Vector2d(0.0, kFooterHeight_mm);
  return needs;
}

// Largest spacing with which the board fits if all its sizes change in proportion, in whole tenths of a
// millimetre; not positive if the paper has no space.
double largestSpacing_mm(const Board& board, const SheetNeeds& needs, const Paper& paper) {
  const Eigen::Vector2d around_mm = needs.whole_mm - needs.pattern.size_mm;
  double scale = 0.0;
  for (const Eigen::Vector2d& size_mm :
       {Eigen::Vector2d(paper.short_mm, paper.long_mm), Eigen::Vector2d(paper.long_mm, paper.short_mm)})
    scale = std::max(scale, ((size_mm - around_mm).array() / needs.pattern.size_mm.array()).minCoeff());
  return std::floor(1e4 * scale * board.spacing_m) / 10.0;
}

// Portrait or landscape, as the board fits.
Eigen::Vector2d paperSize_mm(const Paper& paper, const Board& board, const SheetNeeds& needs) {
  const Eigen::Vector2d upright(paper.short_mm, paper.long_mm), lying(paper.long_mm, paper.short_mm);
  constexpr double kRounding_mm = 1e-6;
  for (const Eigen::Vector2d& size_mm : {upright, lying})
    if ((needs.whole_mm.array() <= size_mm.array() + kRounding_mm).all()) return size_mm;
  const double spacing_mm = largestSpacing_mm(board, needs, paper);
  throw badInput(
      "board",
      fmt::format("needs {:.0f} mm x {:.0f} mm with margins and ruler; {} has {:.0f} mm x {:.0f} mm",
                  needs.whole_mm.x(), needs.whole_mm.y(), paper.name, paper.short_mm, paper.long_mm),
      "Use larger paper, fewer rows or columns, or a smaller margin" +
          (spacing_mm > 0.0 ? fmt::format("; with all sizes in proportion, a spacing of {} mm fits",
                                          shortNumber(spacing_mm))
                            : std::string()));
}

}  // namespace

std::string shortNumber(double value) {
  std::string text = fmt::format("{:.3f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

const std::vector<Paper>& papers() {
  static const std::vector<Paper> all = {{"A4", 210.0, 297.0}, {"Letter", 215.9, 279.4},
                                         {"A3", 297.0, 420.0}, {"A2", 420.0, 594.0},
                                         {"A1", 594.0, 841.0}, {"A0", 841.0, 1189.0}};
  return all;
}

bool fitsSheet(const Board& board, const SheetOptions& options) {
  try {
    layOut(board, options, {});
    return true;
  } catch (const CalibrationError&) {
    return false;
  }
}

std::optional<Board> boardThatFits(const Board& board, const SheetOptions& options, const TagPrint& print) {
  if (!options.paper || !isUsable(board)) return std::nullopt;
  const double spacing_m = 1e-3 * largestSpacing_mm(board, needsOf(board, options, print), *options.paper);
  if (!(spacing_m > 0.0)) return std::nullopt;
  Board fitting = board;
  fitting.spacing_m = spacing_m;
  fitting.radius_m *= spacing_m / board.spacing_m;
  fitting.tag_size_m *= spacing_m / board.spacing_m;
  return fitting;
}

BoardSheet layOut(const Board& board, const SheetOptions& options, const TagPrint& print) {
  validate(board);
  if (!(options.margin_m >= 0.0))
    throw badInput("margin", "is negative", "Give a margin in metres, 0 or more");
  const SheetNeeds needs = needsOf(board, options, print);
  const Eigen::Vector2d size_mm =
      options.paper ? paperSize_mm(*options.paper, board, needs) : ownSize_mm(board, needs.whole_mm);
  BoardSheet sheet;
  sheet.width_mm = size_mm.x();
  sheet.height_mm = size_mm.y();
  sheet.radius_mm = 1e3 * board.radius_m;
  // Centred in the area above the footer.
  const Eigen::Vector2d field_at_mm = 0.5 * (size_mm - needs.whole_mm);
  const Eigen::Vector2d first_mm = field_at_mm + Eigen::Vector2d::Constant(1e3 * options.margin_m);
  sheet.field = {field_at_mm.x(), field_at_mm.y(), needs.field_mm.x(), needs.field_mm.y(), false};
  sheet.bright_circles = board.hasCircles() && board.circles == CircleShade::Bright;
  if (sheet.bright_circles) sheet.boxes.push_back(sheet.field);
  for (const Eigen::Vector2d& centre_mm : needs.pattern.centres_mm)
    sheet.centres_mm.push_back(first_mm + centre_mm);
  for (SheetBox box : needs.pattern.boxes) {
    box.x_mm += first_mm.x();
    box.y_mm += first_mm.y();
    sheet.boxes.push_back(box);
  }
  const double footer_mm = sheet.height_mm - kFooterHeight_mm;
  sheet.ruler = {kFooterIndent_mm, footer_mm + kRulerBelow_mm - 0.5 * kRulerWidth_mm, kRulerLength_mm,
                 kRulerWidth_mm, false};
  sheet.caption = fmt::format("Evical board: {}. Print at 100 %; the line is {} mm.", describe(board, print),
                              shortNumber(kRulerLength_mm));
  sheet.caption_x_mm = kFooterIndent_mm;
  sheet.caption_y_mm = footer_mm + kCaptionBelow_mm;
  sheet.text_size_mm =
      std::min(kLargestText_mm, (sheet.width_mm - 2.0 * kFooterIndent_mm) /
                                    (kLetterWidth * static_cast<double>(sheet.caption.size())));
  return sheet;
}

}  // namespace evical
