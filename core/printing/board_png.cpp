#include "core/base/error.h"
#include "core/format/gray_png.h"
#include "core/printing/board_sheet.h"

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

}  // namespace evical
