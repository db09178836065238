#include "core/intrinsics/estimate_intrinsics.h"

#include "core/base/error.h"
#include "core/base/number.h"
#include "core/geometry/camera_model.h"
#include "core/intrinsics/bundle.h"
#include "core/intrinsics/intrinsics_checks.h"
#include "core/intrinsics/intrinsics_start.h"
#include "core/intrinsics/intrinsics_uncertainty.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <vector>

namespace evical {
namespace {

void checkCount(const std::vector<SensorView>& views, std::size_t count, const char* what,
                const IntrinsicsInput& input, const IntrinsicsOptions& options, std::size_t close = 0) {
  if (static_cast<int>(count) >= options.min_views) return;
  const std::string missing = missingPlaces(views, input.resolution_px);
  throw calibrationFailed(
      input.observations.camera,
      fmt::format("only {} at least {:.0f} % of the board, but {} are needed for intrinsics{}{}",
                  counted(count, what, "shows", "show"), 100.0 * options.min_circles, options.min_views,
                  close == 0
                      ? ""
                      : fmt::format("; {} more are within {} s of these", close, options.min_view_spacing_s),
                  missing.empty() ? "" : "; none reaches " + missing),
      "Move the board through the whole image for at least 20 s, and keep it completely in view most of the "
      "time");
}

// Inputs of a solution.
struct Estimation {
  const Board& board;
  Resolution resolution_px;
  std::optional<CameraIntrinsics> guess;
  const IntrinsicsOptions& options;
  const RunContext& context;
  bool wide_too = true;  // whether automatic selection may choose a double sphere
};

// Sum of squared normalised errors, each limited to the squared bound.
double boundedSum(const Bundle& bundle, double bound) {
  double sum = 0.0;
  for (std::size_t v = 0; v < bundle.views.size(); ++v)
    for (const SensorCircle& circle : bundle.views[v].circles) {
      const Eigen::Vector2d error_px = bundle.error_px(v, circle);
      sum += std::min(error_px.dot(circle.covariance_px2.llt().solve(error_px)), bound * bound);
    }
  return sum;
}

// Medians of similar solutions hardly differ.
bool fitsBetter(const Bundle& bundle, const Bundle& other, const IntrinsicsOptions& options) {
  constexpr double kAlike = 1.05;
  const auto [less, more] = std::minmax(bundle.scale, other.scale);
  if (!(more < kAlike * less)) return bundle.scale < other.scale;
  const double bound = options.outlier_sigma * less;
  return boundedSum(bundle, bound) < boundedSum(other, bound);
}

Bundle bestOf(const std::vector<CameraIntrinsics>& starts, const std::vector<SensorView>& views,
              const Estimation& given) {
  std::optional<Bundle> best;
  for (const CameraIntrinsics& start : starts) {
    given.context.throwIfStopped();
    Bundle bundle = solveBundle(start, views, given.board, given.options, given.context);
    if (!best || fitsBetter(bundle, *best, given.options)) best = std::move(bundle);
  }
  if (best->intrinsics.model != CameraModel::DoubleSphere) return *best;
  Bundle other = solveBundle(otherSide(best->intrinsics), views, given.board, given.options, given.context);
  return fitsBetter(other, *best, given.options) ? other : *best;
}

CameraModel modelOf(IntrinsicsModel wanted) {
  return static_cast<CameraModel>(static_cast<int>(wanted) -
                                  static_cast<int>(IntrinsicsModel::PinholeRadtan));
}

int circlesOf(const Bundle& bundle) {
  std::size_t count = 0;
  for (const SensorView& view : bundle.views) count += view.circles.size();
  return static_cast<int>(count);
}

// If all circles are used and the errors are as large as their sigmas, another model cannot fit better.
bool fits(const Bundle& bundle) {
  constexpr double kFits = 1.5, kNearlyAll = 0.95;
  return bundle.scale < kFits && bundle.circlesUsed() >= kNearlyAll * circlesOf(bundle);
}

// Accounts for circles at large angles that a model excludes so that the others fit well.
double misfit(const Bundle& bundle) {
  return bundle.scale * circlesOf(bundle) / std::max(1, bundle.circlesUsed());
}

struct Solution {
  Bundle bundle;
  std::vector<TriedModel> tried;
};

// Equidistant only if radial-tangential does not fit, double sphere only if neither does.
Solution solve(const std::vector<SensorView>& views, const Estimation& given) {
  std::vector<TriedModel> tried;
  const auto with = [&](CameraModel model) {
    Bundle bundle =
        bestOf(intrinsicsStarts(views, given.board, model, given.resolution_px, given.guess), views, given);
    tried.push_back({model, bundle.scale, bundle.circlesUsed(), circlesOf(bundle)});
    return bundle;
  };
  const IntrinsicsModel wanted = given.options.model;
  if (wanted != IntrinsicsModel::Automatic) {
    Bundle bundle = with(modelOf(wanted));
    return {std::move(bundle), std::move(tried)};
  }
  Bundle radtan = with(CameraModel::PinholeRadtan);
  Bundle equidistant = with(CameraModel::PinholeEquidistant);
  Bundle pinhole = equidistant.scale < given.options.equidistant_gain * radtan.scale ? std::move(equidistant)
                                                                                     : std::move(radtan);
  if (!given.wide_too || fits(pinhole)) return {std::move(pinhole), std::move(tried)};
  Bundle sphere = with(CameraModel::DoubleSphere);
  const bool wide = misfit(sphere) < given.options.double_sphere_gain * misfit(pinhole);
  return {wide ? std::move(sphere) : std::move(pinhole), std::move(tried)};
}

void addFit(const Bundle& bundle, IntrinsicsResult& result) {
  int all = 0;
  double squares = 0.0;
  for (std::size_t v = 0; v < bundle.views.size(); ++v) {
    for (const SensorCircle& circle : bundle.views[v].circles) {
      ++all;
      if (!circle.used) continue;
      squares += bundle.error_px(v, circle).squaredNorm();
    }
  }
  result.circles_used = bundle.circlesUsed();
  result.circles_rejected = all - result.circles_used;
  result.views_used = bundle.viewsUsed();
  result.reprojection_rms_px = std::sqrt(squares / std::max(1, result.circles_used));
}

bool hasLead(const Bundle& bundle) {
  const auto leads = [](const SensorCircle& circle) { return !circle.lead_effect.isZero(); };
  return std::any_of(bundle.views.begin(), bundle.views.end(), [&](const SensorView& view) {
    return std::any_of(view.circles.begin(), view.circles.end(), leads);
  });
}

}  // namespace

IntrinsicsResult estimateIntrinsics(const IntrinsicsInput& input, const IntrinsicsOptions& options,
                                    const RunContext& context, IntrinsicsStory* story) {
  const std::vector<SensorView> all =
      sensorViews(input.observations, input.board, input.detection_intrinsics, options);
  checkCount(all, all.size(), "view", input, options);
  const CameraIntrinsics rough =
      input.start ? *input.start
                  : roughStart(all, input.board, input.resolution_px, input.detection_intrinsics);
  const std::vector<SensorView> views = selectViews(all, input.board, rough, options);
  checkCount(views, views.size(), "well-spaced view", input, options, all.size() - views.size());
  const Estimation given{input.board, input.resolution_px, input.detection_intrinsics, options, context};
  Solution solution = input.start ? Solution{bestOf({*input.start}, views, given), {}} : solve(views, given);
  const Bundle& bundle = solution.bundle;

  IntrinsicsResult result;
  result.intrinsics = bundle.intrinsics;
  result.edge_localisation_bias_px = bundle.edge_localisation_bias_px;
  result.views_found = static_cast<int>(input.observations.views.size());
  addFit(bundle, result);
  checkCount(views, static_cast<std::size_t>(result.views_used), "consistent view", input, options);
  const BundleUncertainty uncertainty = bundleUncertainty(bundle, input.board, options);
  result.covariance = uncertainty.covariance;
  // Only moving edges in events have a lead; otherwise the value would be the prior's.
  if (hasLead(bundle)) result.edge_localisation_bias_std_px = uncertainty.edge_localisation_bias_std_px;
  result.normalised_rms = uncertainty.normalised_rms;
  result.largest_tilt_deg = largestTilt_deg(bundle);
  checkTilts(bundle, focalLengthRelativeStd(result.intrinsics, result.covariance), options);
  result.image = imageMap(bundle, result.covariance);
  result.advice = coverageAdvice(bundle, result.image);
  judge(bundle.converged, options, result);
  if (story != nullptr) *story = {std::move(solution.tried), viewsOf(bundle, input.board)};
  return result;
}

std::optional<RoughCamera> roughCamera(const std::vector<SensorView>& all, const Board& board,
                                       const CameraIntrinsics& guess, const IntrinsicsOptions& options,
                                       const RunContext& context) {
  constexpr std::size_t kMinViews = 4, kMaxViews = 40;
  constexpr int kMaxIterations = 15;        // convergence along a valley is left to the whole recording
  constexpr bool kWideToo = false;          // the front end sees up to 85 degrees, where a pinhole suffices
  constexpr double kMaxFocalLength = 20.0;  // image widths: similar views can diverge
  if (all.size() < kMinViews) return std::nullopt;
  std::vector<SensorView> views;
  const std::size_t every = (all.size() + kMaxViews - 1) / kMaxViews;
  for (std::size_t k = 0; k < all.size(); k += every) views.push_back(all[k]);
  IntrinsicsOptions rough = options;
  rough.max_iterations = std::min(options.max_iterations, kMaxIterations);
  const Bundle bundle = solve(views, {board, guess.resolution_px, guess, rough, context, kWideToo}).bundle;
  const CameraIntrinsics& camera = bundle.intrinsics;
  const bool sane = camera.focal_length_px.allFinite() && camera.focal_length_px.minCoeff() > 1.0 &&
                    idealFocalLength_px(camera).maxCoeff() < kMaxFocalLength * guess.resolution_px.width_px &&
                    unproject(camera, camera.principal_point_px);
  if (!sane || bundle.circlesUsed() == 0) return std::nullopt;
  const BundleUncertainty uncertainty = bundleUncertainty(bundle, board, options);
  if (uncertainty.normalised_rms == 0.0) return std::nullopt;  // not more circles than unknowns
  return RoughCamera{camera, imageMap(bundle, uncertainty.covariance).rms_px};
}

}  // namespace evical
