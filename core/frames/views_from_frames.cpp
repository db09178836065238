#include "core/frames/views_from_frames.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <optional>

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

}  // namespace evical
