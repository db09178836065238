#include "core/frames/still_views.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace evical {
namespace {

constexpr std::size_t kFewest = 4;  // an affine change of a plane needs three
constexpr double kNoise = 4.0;      // outlier limit of single points relative to the board's motion

struct Mean {
  int count = 0;
  FoundPoint sum;
};

PointsInFrame meanOf(const std::vector<PointsInFrame>& views, double common_sigma_px) {
  std::map<int, Mean> means;
  PointsInFrame mean;
  for (const PointsInFrame& view : views) {
    mean.time_s += view.time_s / static_cast<double>(views.size());
    for (const FoundPoint& point : view.points) {
      Mean& of_point = means[point.point];
      if (of_point.count++ == 0) {
        of_point.sum = point;
        continue;
      }
      of_point.sum.at_px += point.at_px;
      of_point.sum.covariance_px2 += point.covariance_px2;
      of_point.sum.ellipse_px2 += point.ellipse_px2;
    }
  }
  const Eigen::Matrix2d common_px2 = common_sigma_px * common_sigma_px * Eigen::Matrix2d::Identity();
  for (auto& [index, of_point] : means) {
    FoundPoint& point = mean.points.emplace_back(of_point.sum);
    const double count = of_point.count;
    point.at_px /= count;
    point.ellipse_px2 /= count;
    point.covariance_px2 = (point.covariance_px2 / count - common_px2) / count + common_px2;
  }
  return mean;
}

}  // namespace

std::optional<double> movement_px(const FoundPoints& from, const FoundPoints& to) {
  std::vector<Eigen::Vector2d> places, shifts;
  for (const FoundPoint& a : from)
    for (const FoundPoint& b : to)
      if (a.point == b.point) {
        places.push_back(a.at_px);
        shifts.emplace_back(b.at_px - a.at_px);
      }
  if (places.size() < kFewest || 2 * places.size() < std::max(from.size(), to.size())) return std::nullopt;
  const auto count = static_cast<Eigen::Index>(places.size());
  Eigen::Matrix<double, Eigen::Dynamic, 3> design(count, 3);
  Eigen::Matrix<double, Eigen::Dynamic, 2> measured(count, 2);
  for (Eigen::Index k = 0; k < count; ++k) {
    design.row(k) << 1.0, places[static_cast<std::size_t>(k)].transpose();
    measured.row(k) = shifts[static_cast<std::size_t>(k)].transpose();
  }
  const Eigen::Matrix<double, 3, 2> affine = design.colPivHouseholderQr().solve(measured);
  return (design * affine).norm() / std::sqrt(static_cast<double>(count));
}

FoundPoints numberedAs(const FoundPoints& earlier, const FoundPoints& later, double nearest_px) {
  FoundPoints numbered;
  for (const FoundPoint& place : earlier)
    for (const FoundPoint& point : later)
      if ((point.at_px - place.at_px).norm() < nearest_px) {
        numbered.push_back(point);
        numbered.back().point = place.point;
        break;
      }
  return numbered;
}

std::vector<PointsInFrame> joinedWhileStill(const std::vector<PointsInFrame>& views, double still_px,
                                            double common_sigma_px) {
  std::vector<PointsInFrame> joined;
  for (std::size_t begin = 0; begin < views.size();) {
    const FoundPoints& first = views[begin].points;
    std::vector<PointsInFrame> still = {views[begin]};
    for (++begin; begin < views.size(); ++begin) {
      PointsInFrame next = views[begin];
      next.points = numberedAs(first, next.points, kNoise * still_px);
      const std::optional<double> moved = movement_px(first, next.points);
      if (!moved || *moved >= still_px) break;
      still.push_back(std::move(next));
    }
    joined.push_back(meanOf(still, common_sigma_px));
  }
  return joined;
}

}  // namespace evical
