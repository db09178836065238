#include "tests/benchmarks/centre_truth.h"

#include "core/geometry/camera_model.h"
#include "core/synthetic/board_truth.h"
#include "core/synthetic/session_errors.h"
#include "core/synthetic/sinusoid_motion.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace evical::benchmarks {
namespace {

const TrueCircle* find(const std::vector<TrueCircle>& circles, int circle) {
  const auto found = std::find_if(circles.begin(), circles.end(),
                                  [&](const TrueCircle& truth) { return truth.circle == circle; });
  return found == circles.end() ? nullptr : &*found;
}

// Index of the last limit that is not above the value.
template <std::size_t N>
std::size_t binOf(const std::array<double, N>& limits, double value) {
  return static_cast<std::size_t>(std::ranges::upper_bound(limits, value) - limits.begin() - 1);
}

template <class Window>
Eigen::Vector2d meanOf(const Window& window) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const auto& each : window) sum += each.px;
  return sum / static_cast<double>(window.size());
}

}  // namespace

std::vector<CentreError> errorsOf(const Scenario& scenario, const BoardObservations& observations) {
  constexpr double kStep_s = 1e-3;  // of the difference that gives accelerations
  const SinusoidMotion motion(scenario);
  const CameraIntrinsics& camera = scenario.cameras.front().intrinsics;
  const CameraIntrinsics stated = asSessionSays(scenario).cameras.front().intrinsics;
  std::vector<CentreError> errors;
  std::vector<int> circles;
  std::vector<Eigen::Vector2d> truths;
  for (const BoardView& view : observations.views) {
    for (const CircleObservation& circle : view.circles) {
      const auto at = [&](double time_s) { return trueBoardView(motion, scenario, 0, time_s); };
      const std::vector<TrueCircle> now = at(circle.time_s), before = at(circle.time_s - kStep_s),
                                    after = at(circle.time_s + kStep_s);
      const TrueCircle *truth = find(now, circle.circle), *earlier = find(before, circle.circle),
                       *later = find(after, circle.circle);
      if (!truth || !earlier || !later) continue;
      CentreError error;
      error.circle = circle.circle;
      error.place_spacings = scenario.board.point_m(circle.circle) / scenario.board.spacing_m;
      error.view = static_cast<std::size_t>(&view - observations.views.data());
      // In ideal pixels of the lens that the session states.
      const auto stated_px = idealPixel(stated, pixelFromIdeal(camera, truth->centre_px));
      if (!stated_px) continue;
      error.error_px = circle.centre_px - *stated_px;
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

void ErrorAgreement::addWindow(std::span<const Left> window) {
  for (std::size_t i = 0; i < window.size(); ++i) {
    const CentreError& error = *window[i].error;
    const std::size_t speed = binOf(kSpeeds_px_s, error.speed_px_s);
    stated_px2_[speed].add(0.5 * (error.whitening.transpose() * error.whitening).inverse().trace());
    for (std::size_t k = i; k < window.size(); ++k) {
      const double distance = (error.place_spacings - window[k].error->place_spacings).norm();
      products_px2_[speed][binOf(kDistances, distance)].add(0.5 * window[i].px.dot(window[k].px));
    }
  }
}

void ErrorAgreement::addLater(std::span<const Left> window, std::span<const Left> later, std::size_t lag) {
  const Eigen::Vector2d mean_px = meanOf(window), later_mean_px = meanOf(later);
  windows_px2_[lag].add(0.5 * mean_px.dot(later_mean_px));
  for (const Left& each : window)
    for (const Left& same : later)
      if (same.error->circle == each.error->circle)
        circles_px2_[lag].add(0.5 * (each.px - mean_px).dot(same.px - later_mean_px));
}

void ErrorAgreement::add(const std::vector<CentreError>& errors, const ErrorFit& fit) {
  constexpr double kWild = 6.0;
  std::vector<Left> left;
  for (const CentreError& error : errors) {
    const Eigen::Vector2d px =
        error.error_px + fit.delay_s * error.velocity_px_s - fit.lead_px * error.lead_effect;
    if ((error.whitening * px).norm() < kWild * std::max(1.0, fit.chi)) left.push_back({px, &error});
  }
  std::vector<std::span<const Left>> windows;
  for (std::size_t begin = 0, end = 0; begin < left.size(); begin = end) {
    while (end < left.size() && left[end].error->view == left[begin].error->view) ++end;
    addWindow(windows.emplace_back(&left[begin], end - begin));
  }
  for (std::size_t w = 0; w < windows.size(); ++w)
    for (std::size_t lag = 0; lag < windows_px2_.size() && w + lag < windows.size(); ++lag)
      addLater(windows[w], windows[w + lag], lag);
}

void ErrorAgreement::print() const {
  constexpr std::array kNames = {"0 to 20", "20 to 40", "40 to 70", "70 to 120", "120 to 200", "from 200"};
  fmt::print(
      "\n| image speed, px/s | circles | error, px | stated, px | correlation of circles 1.4 spacings apart "
      "| 2 | 2 to "
      "2.9 | 2.9 to 4 | 4 to 5.5 | 5.5 to 8 | further | shared by neighbours, px |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t s = 0; s < kSpeeds_px_s.size(); ++s) {
    const auto& products = products_px2_[s];
    if (products[0].weight == 0.0) continue;
    fmt::print("| {} | {} | {:.4f} | {:.4f} |", kNames[s], products[0].weight, std::sqrt(products[0].value()),
               std::sqrt(stated_px2_[s].value()));
    for (std::size_t d = 1; d < kDistances.size(); ++d)
      fmt::print(" {:.2f} |", products[d].value() / std::max(products[0].value(), 1e-12));
    fmt::print(" {:.4f} |\n", std::sqrt(std::max(0.0, products[1].value())));
  }
  const auto printLater = [](const char* what, const std::array<Mean, 5>& products) {
    fmt::print("\nCorrelation of {} with that 1 to 4 windows later:", what);
    for (std::size_t lag = 1; lag < products.size(); ++lag)
      fmt::print(" {:.2f}", products[lag].value() / std::max(products[0].value(), 1e-12));
    fmt::print("\n");
  };
  printLater("the mean of a window", windows_px2_);
  printLater("a circle, less the mean,", circles_px2_);
}

int wrongWindows(const Scenario& scenario, const BoardObservations& observations) {
  constexpr double kUnknown_px = 2.0, kWrong = 0.4;  // of the smallest step
  const Board& board = scenario.board;
  const double step_m = board.type == BoardType::AprilGrid
                            ? std::min(board.tag_size_m, board.spacing_m - board.tag_size_m)
                            : board.spacing_m;
  const double f_px = idealFocalLength_px(scenario.cameras[0].intrinsics).minCoeff();
  const double step_px = step_m * f_px / (scenario.motion.distance_m + scenario.motion.distance_amplitude_m);
  const SinusoidMotion motion(scenario);
  int wrong = 0;
  for (const BoardView& view : observations.views) {
    const std::vector<TrueCircle> at_view = trueBoardView(motion, scenario, 0, view.time_s);
    const auto isWrongAt = [&](const CircleObservation& corner, double time_s,
                               const std::vector<TrueCircle>& truths) {
      const TrueCircle* const truth = find(truths, corner.circle);
      if (truth == nullptr) return true;
      const Eigen::Vector2d error_px =
          corner.centre_px + (time_s - corner.time_s) * corner.velocity_px_s - truth->centre_px;
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(corner.covariance_px2);
      for (Eigen::Index k = 0; k < 2; ++k)
        if (axes.eigenvalues()[k] < kUnknown_px * kUnknown_px &&
            std::abs(axes.eigenvectors().col(k).dot(error_px)) > std::max(kWrong * step_px, 1.5))
          return true;
      return false;
    };
    // The corner's own time counts; the view's is faster to compare with.
    const auto isWrong = [&](const CircleObservation& corner) {
      return isWrongAt(corner, view.time_s, at_view) &&
             isWrongAt(corner, corner.time_s, trueBoardView(motion, scenario, 0, corner.time_s));
    };
    const auto corners = std::count_if(view.circles.begin(), view.circles.end(), isWrong);
    if (corners > 0)
      fmt::print(stderr, "wrong at {:.3f} s: {} of {} corners\n", view.time_s, corners, view.circles.size());
    wrong += corners > 0;
  }
  return wrong;
}

}  // namespace evical::benchmarks
