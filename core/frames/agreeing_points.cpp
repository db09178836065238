#include "core/frames/agreeing_points.h"

#include "core/geometry/homography.h"

#include <opencv2/calib3d.hpp>

#include <utility>

namespace evical {

std::vector<ReadPoint> agreeingPoints(const std::vector<ReadPoint>& points, double tolerance_px) {
  if (points.size() < kLeastForHomography) return {};
  std::vector<cv::Point2d> from, to;
  for (const ReadPoint& point : points) {
    from.emplace_back(point.on_board_m.x(), point.on_board_m.y());
    to.emplace_back(point.at_px.x(), point.at_px.y());
  }
  std::vector<std::uint8_t> agrees;
  if (cv::findHomography(from, to, cv::RANSAC, tolerance_px, agrees).empty()) return {};
  std::vector<ReadPoint> agreeing;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (agrees[k] != 0) agreeing.push_back(points[k]);
  if (2 * agreeing.size() < points.size()) agreeing.clear();
  return agreeing;
}

std::optional<PlaneMap> mapOf(const std::vector<ReadPoint>& points, double step_m) {
  std::vector<Eigen::Vector2d> on_board, in_picture;
  for (const ReadPoint& point : points) {
    on_board.push_back(point.on_board_m);
    in_picture.push_back(point.at_px);
  }
  return PlaneMap::fit(std::move(on_board), in_picture, step_m);
}

}  // namespace evical
