#include "core/frames/views_from_frames.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace evical {
namespace {

constexpr double kLongestGap_s = 0.5;  // in a longer time a hand may reverse its motion
constexpr double kBlurShare = 0.1;

const FoundPoint* pointOf(const PointsInFrame& frame, int point) {
  const auto found = std::lower_bound(frame.points.begin(), frame.points.end(), point,
                                      [](const FoundPoint& p, int wanted) { return p.point < wanted; });
  return found != frame.points.end() && found->point == point ? &*found : nullptr;
}

std::optional<Eigen::Vector2d> between(const PointsInFrame& from, const PointsInFrame& to, int point) {
  const double gap_s = to.time_s - from.time_s;
  const FoundPoint *a = pointOf(from, point), *b = pointOf(to, point);
  if (a == nullptr || b == nullptr || !(gap_s > 0.0) || gap_s > kLongestGap_s) return std::nullopt;
  return (b->at_px - a->at_px) / gap_s;
}

// Slope of the parabola if both neighbours are known.
Eigen::Vector2d velocityOf(const std::vector<PointsInFrame>& frames, std::size_t k, int point) {
  std::optional<Eigen::Vector2d> before, after;
  if (k > 0) before = between(frames[k - 1], frames[k], point);
  if (k + 1 < frames.size()) after = between(frames[k], frames[k + 1], point);
  if (!before || !after) return after ? *after : before.value_or(Eigen::Vector2d::Zero());
  const double a = frames[k].time_s - frames[k - 1].time_s, b = frames[k + 1].time_s - frames[k].time_s;
  return (b * *before + a * *after) / (a + b);
}

void setEllipse(const Eigen::Matrix2d& ellipse_px2, CircleObservation& seen) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(ellipse_px2);
  seen.semi_axes_px = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().reverse();
  seen.angle_rad = std::atan2(eigen.eigenvectors()(1, 1), eigen.eigenvectors()(0, 1));
}

double medianSpeed(const BoardView& view) {
  std::vector<double> speeds;
  for (const CircleObservation& point : view.circles) speeds.push_back(point.velocity_px_s.norm());
  if (speeds.empty()) return 0.0;
  const auto middle = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2);
  std::nth_element(speeds.begin(), middle, speeds.end());
  return *middle;
}

// Mean over the frames with known exposure.
double meanExposure_s(const std::vector<PointsInFrame>& frames) {
  double sum_s = 0.0;
  int count = 0;
  for (const PointsInFrame& frame : frames) {
    sum_s += frame.exposure_s;
    count += frame.exposure_s > 0.0 ? 1 : 0;
  }
  return count > 0 ? sum_s / count : 0.0;
}

}  // namespace

std::vector<ViewFromFrame> viewsFromFrames(const std::vector<PointsInFrame>& frames, int points_of_board) {
  std::vector<ViewFromFrame> views;
  const double mean_exposure_s = meanExposure_s(frames);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const PointsInFrame& frame = frames[k];
    ViewFromFrame& made = views.emplace_back();
    made.view.time_s = frame.time_s;
    made.view.kind =
        static_cast<int>(frame.points.size()) == points_of_board ? ViewKind::Complete : ViewKind::Partial;
    for (const FoundPoint& point : frame.points) {
      CircleObservation& seen = made.view.circles.emplace_back();
      seen.circle = point.point;
      seen.time_s = frame.time_s;
      seen.centre_px = point.at_px;
      seen.velocity_px_s = velocityOf(frames, k, point.point);
      if (frame.exposure_s > 0.0) seen.longer_exposed_s = frame.exposure_s - mean_exposure_s;
      setEllipse(point.ellipse_px2, seen);
      const Eigen::Vector2d blur = kBlurShare * frame.exposure_s * seen.velocity_px_s;
      seen.covariance_px2 = point.covariance_px2 + blur * blur.transpose();
    }
    made.speed_px_s = medianSpeed(made.view);
  }
  return views;
}

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
