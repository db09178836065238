#include "core/frontend/drawing_canvas.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

constexpr int kShift = 4;  // OpenCV draws with fractional coordinates
constexpr int kBar_px = 30;
constexpr Colour kBackground = {16, 18, 24}, kBar = {34, 38, 48}, kText = {236, 238, 242};
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kTextSize = 0.5, kLabelSize = 0.4;

cv::Scalar scalar(Colour colour) {
  return {double(colour.r), double(colour.g), double(colour.b)};
}

}  // namespace

DrawingCanvas::DrawingCanvas(Resolution resolution_px, int wanted_width_px)
    : factor_(std::max(
          1, static_cast<int>(std::lround(static_cast<double>(wanted_width_px) / resolution_px.width_px)))),
      canvas_(resolution_px.height_px * factor_ + 2 * kBar_px, resolution_px.width_px * factor_, CV_8UC3,
              scalar(kBackground)) {}

cv::Point DrawingCanvas::fixed(const Eigen::Vector2d& pixel) const {
  // Avoids overflow of OpenCV's integers further outside the picture.
  constexpr double kFarthest_px = 1e5;
  const Eigen::Vector2d p =
      ((pixel.array() + 0.5) * factor_ - 0.5).cwiseMax(-kFarthest_px).cwiseMin(kFarthest_px);
  return {static_cast<int>(std::lround(p.x() * (1 << kShift))),
          static_cast<int>(std::lround((p.y() + kBar_px) * (1 << kShift)))};
}

void DrawingCanvas::pixel(int x_px, int y_px, Colour colour, double brightness) {
  const auto mixed = [&](std::uint8_t from, std::uint8_t to) {
    return static_cast<std::uint8_t>(std::lround(from + std::clamp(brightness, 0.0, 1.0) * (to - from)));
  };
  const cv::Vec3b mix(mixed(kBackground.r, colour.r), mixed(kBackground.g, colour.g),
                      mixed(kBackground.b, colour.b));
  cv::Mat cell = canvas_({x_px * factor_, y_px * factor_ + kBar_px, factor_, factor_});
  const cv::Vec3b before = cell.at<cv::Vec3b>(0, 0);
  const auto sum = [](const cv::Vec3b& c) { return c[0] + c[1] + c[2]; };
  if (sum(mix) > sum(before)) cell.setTo(cv::Scalar(mix[0], mix[1], mix[2]));
}

void DrawingCanvas::line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, Colour colour,
                         int thickness) {
  if (!from.allFinite() || !to.allFinite()) return;
  cv::line(canvas_, fixed(from), fixed(to), scalar(colour), thickness, cv::LINE_AA, kShift);
}

void DrawingCanvas::arrow(const Eigen::Vector2d& from, const Eigen::Vector2d& to, Colour colour) {
  line(from, to, colour, 2);
  const Eigen::Vector2d along = to - from;
  const double length = along.norm();
  if (!(length > 0.5)) return;
  const Eigen::Vector2d back = -along / length * std::min(0.35 * length, 3.0);
  const Eigen::Vector2d side(-back.y(), back.x());
  line(to, to + back + 0.5 * side, colour, 2);
  line(to, to + back - 0.5 * side, colour, 2);
}

void DrawingCanvas::circle(const Eigen::Vector2d& centre, double radius_px, Colour colour, int thickness) {
  if (!centre.allFinite() || !(radius_px < 1e4)) return;
  cv::circle(canvas_, fixed(centre), static_cast<int>(std::lround(radius_px * factor_ * (1 << kShift))),
             scalar(colour), thickness, cv::LINE_AA, kShift);
}

void DrawingCanvas::outline(const std::vector<Eigen::Vector2d>& points, Colour colour, int thickness) {
  std::vector<cv::Point> corners;
  for (const Eigen::Vector2d& point : points) {
    if (!point.allFinite()) return;
    corners.push_back(fixed(point));
  }
  cv::polylines(canvas_, corners, true, scalar(colour), thickness, cv::LINE_AA, kShift);
}

void DrawingCanvas::cross(const Eigen::Vector2d& centre, Colour colour) {
  const double arm = 4.0 / factor_;
  line(centre - Eigen::Vector2d(arm, 0), centre + Eigen::Vector2d(arm, 0), colour);
  line(centre - Eigen::Vector2d(0, arm), centre + Eigen::Vector2d(0, arm), colour);
}

void DrawingCanvas::label(const Eigen::Vector2d& beside, const std::string& text, Colour colour) {
  if (!beside.allFinite()) return;
  const cv::Point corner = fixed(beside);
  const cv::Point at((corner.x >> kShift) + 5, (corner.y >> kShift) - 5);
  cv::putText(canvas_, text, at, kFont, kLabelSize, scalar(kBackground), 3, cv::LINE_AA);
  cv::putText(canvas_, text, at, kFont, kLabelSize, scalar(colour), 1, cv::LINE_AA);
}

void DrawingCanvas::title(const std::string& text) {
  cv::rectangle(canvas_, {0, 0, canvas_.cols, kBar_px}, scalar(kBar), cv::FILLED);
  cv::putText(canvas_, text, {10, kBar_px - 10}, kFont, kTextSize, scalar(kText), 1, cv::LINE_AA);
}

void DrawingCanvas::legend(const std::vector<std::pair<std::string, Colour>>& words) {
  cv::rectangle(canvas_, {0, canvas_.rows - kBar_px, canvas_.cols, kBar_px}, scalar(kBar), cv::FILLED);
  int x = 10;
  for (const auto& [word, colour] : words) {
    cv::putText(canvas_, word, {x, canvas_.rows - 10}, kFont, kTextSize, scalar(colour), 1, cv::LINE_AA);
    int baseline = 0;
    x += cv::getTextSize(word, kFont, kTextSize, 1, &baseline).width + 22;
  }
}

RgbImage DrawingCanvas::image() const {
  RgbImage out{canvas_.cols, canvas_.rows, {}};
  out.rgb.assign(canvas_.datastart, canvas_.dataend);
  return out;
}

}  // namespace evical
