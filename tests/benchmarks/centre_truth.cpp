#include "tests/benchmarks/centre_truth.h"

#include "core/geometry/camera_model.h"
#include "core/optimisation/common_displacement.h"
#include "core/optimisation/optimisation_options.h"
#include "core/synthetic/board_truth.h"
#include "core/synthetic/sinusoid_motion.h"

#include <Eigen/LU>

namespace evical::benchmarks {
namespace {

const TrueCircle* find(const std::vector<TrueCircle>& circles, int circle) {
  const auto found = std::find_if(circles.begin(), circles.end(),
                                  [&](const TrueCircle& truth) { return truth.circle == circle; });
  return found == circles.end() ? nullptr : &*found;
}

struct WindowError {
  double speed_px_s = 0.0;
  Eigen::Vector2d along_across_px = Eigen::Vector2d::Zero();
  double by_centres_px2 = 0.0, stated_px2 = 0.0;  // variance an axis
};

// The weighted mean of the errors of a window, of which there are `count`.
WindowError windowError(const CentreError* first, std::size_t count, const ErrorFit& fit) {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), velocity = Eigen::Vector2d::Zero();
  double common_px2 = 0.0;
  WindowError window;
  for (const CentreError* error = first; error != first + count; ++error) {
    const Eigen::Matrix2d weight = error->whitening.transpose() * error->whitening;
    information += weight;
    sum += weight * (error->error_px + fit.delay_s * error->velocity_px_s - fit.lead_px * error->lead_effect);
    velocity += error->velocity_px_s;
    common_px2 += error->common_px * error->common_px / static_cast<double>(count);
  }
  const Eigen::Vector2d mean_px = information.inverse() * sum;
  const Eigen::Vector2d along = velocity.norm() > 0.0 ? velocity.normalized() : Eigen::Vector2d::UnitX();
  window.speed_px_s = velocity.norm() / static_cast<double>(count);
  window.along_across_px = {along.dot(mean_px), along.x() * mean_px.y() - along.y() * mean_px.x()};
  window.by_centres_px2 = 0.5 * information.inverse().trace();
  window.stated_px2 = window.by_centres_px2 + common_px2;
  return window;
}

}  // namespace

std::vector<CentreError> errorsOf(const Scenario& scenario, const BoardObservations& observations) {
  constexpr double kStep_s = 1e-3;  // of the difference that gives accelerations
  const SinusoidMotion motion(scenario);
  const CameraIntrinsics& camera = scenario.cameras.front().intrinsics;
  std::vector<CentreError> errors;
  std::vector<int> circles;
  std::vector<Eigen::Vector2d> truths;
  const OptimisationOptions options;
  for (const BoardView& view : observations.views) {
    for (const CircleObservation& circle : view.circles) {
      const auto at = [&](double time_s) { return trueBoardView(motion, scenario, 0, time_s); };
      const std::vector<TrueCircle> now = at(circle.time_s), before = at(circle.time_s - kStep_s),
                                    after = at(circle.time_s + kStep_s);
      const TrueCircle *truth = find(now, circle.circle), *earlier = find(before, circle.circle),
                       *later = find(after, circle.circle);
      if (!truth || !earlier || !later) continue;
      CentreError error;
      error.view = static_cast<std::size_t>(&view - observations.views.data());
      error.common_px = commonDisplacement_px(observations.kind, circle, options);
      error.error_px = circle.centre_px - truth->centre_px;
      error.velocity_px_s = truth->velocity_px_s;
      error.acceleration_px_s2 = (later->velocity_px_s - earlier->velocity_px_s) / (2.0 * kStep_s);
      error.lead_effect = circle.edge_localisation_bias_effect;
      error.whitening = circle.covariance_px2.inverse().llt().matrixU();
      error.speed_px_s = (idealPixelScale(camera, truth->centre_px).inverse() * truth->velocity_px_s).norm();
      errors.push_back(error);
      circles.push_back(circle.circle);
      truths.push_back(truth->centre_px);
    }
  }
  std::vector<Eigen::Vector2d> means(static_cast<std::size_t>(scenario.board.pointCount()),
                                     Eigen::Vector2d::Zero());
  std::vector<double> counts(means.size(), 0.0);
  for (std::size_t k = 0; k < truths.size(); ++k) {
    const auto i = static_cast<std::size_t>(circles[k]);
    means[i] += (truths[k] - means[i]) / ++counts[i];
  }
  for (std::size_t k = 0; k < truths.size(); ++k)
    errors[k].from_mean_px = truths[k] - means[static_cast<std::size_t>(circles[k])];
  return errors;
}

std::array<CommonErrors, 5> commonErrors(const std::vector<CentreError>& errors, const ErrorFit& fit) {
  constexpr std::size_t kEnoughCircles = 5;
  std::vector<WindowError> windows;
  for (std::size_t begin = 0, end = 0; begin < errors.size(); begin = end) {
    while (end < errors.size() && errors[end].view == errors[begin].view) ++end;
    if (end - begin >= kEnoughCircles) windows.push_back(windowError(&errors[begin], end - begin, fit));
  }
  std::ranges::sort(windows, {}, &WindowError::speed_px_s);
  std::array<CommonErrors, 5> fifths;
  for (std::size_t k = 0; k < fifths.size(); ++k) {
    const std::size_t begin = k * windows.size() / fifths.size(),
                      end = (k + 1) * windows.size() / fifths.size();
    if (begin == end) continue;
    Eigen::Array4d squares = Eigen::Array4d::Zero();
    for (std::size_t i = begin; i < end; ++i) {
      const WindowError& window = windows[i];
      squares +=
          Eigen::Array4d(std::pow(window.along_across_px.x(), 2), std::pow(window.along_across_px.y(), 2),
                         window.by_centres_px2, window.stated_px2);
    }
    const Eigen::Array4d rms = (squares / static_cast<double>(end - begin)).sqrt();
    fifths[k] = {windows[end - 1].speed_px_s, rms[0], rms[1], rms[2], rms[3]};
  }
  return fifths;
}

}  // namespace evical::benchmarks
