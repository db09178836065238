#include "core/optimisation/circle_errors.h"

#include "core/base/in_parallel.h"
#include "core/numerics/robust.h"
#include "core/optimisation/displacement_field.h"
#include "core/optimisation/view_circles.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace evical {
namespace {

// Before a selection, circles far from the median error of their view take no part in its displacement.
CircleFlags nearMedian(const std::vector<CircleMeasurement>& circles, std::span<const CircleError> errors,
                       double outlier_sigma) {
  std::vector<double> x_px, y_px, deviations2;
  for (const CircleError& error : errors) {
    if (!error.inFront()) continue;
    x_px.push_back(error.error_px.x());
    y_px.push_back(error.error_px.y());
  }
  const Eigen::Vector2d median_px(medianOf(std::move(x_px)), medianOf(std::move(y_px)));
  const auto deviation2 = [&](std::size_t i) {
    return (circles[i].whitening_px * (errors[i].error_px - median_px)).squaredNorm();
  };
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (errors[i].inFront()) deviations2.push_back(deviation2(i));
  const double bound = outlier_sigma * std::max(1.0, scaleOfPoints(std::move(deviations2)));
  CircleFlags near;
  for (std::size_t i = 0; i < errors.size(); ++i)
    near.push_back(errors[i].inFront() && deviation2(i) <= bound * bound);
  return near;
}

// Distance of each circle's nearest neighbour.
double nearestPoints_spacings(const Board& board) {
  return board.type == BoardType::AsymmetricCircles ? std::sqrt(2.0) : 1.0;
}

// Whitens the errors of one view for the displacement that these of its circles have in common, as the
// solution does.
void normalise(const FieldModes& modes, const std::vector<CircleMeasurement>& circles,
               const CircleFlags& common, std::span<CircleError> errors) {
  std::vector<DisplacementField::Circle> displaced;
  std::vector<double> whitened;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!common[i]) continue;
    displaced.push_back({circles[i].point, circles[i].rho});
    const Eigen::Vector2d in_sigmas = circles[i].whitening_px * errors[i].error_px;
    whitened.insert(whitened.end(), {in_sigmas.x(), in_sigmas.y()});
  }
  if (modes.size() > 0) DisplacementField(modes, displaced).whiten(whitened.data(), 1);
  const double* next = whitened.data();
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!common[i]) continue;
    errors[i].normalised2 = Eigen::Map<const Eigen::Vector2d>(next).squaredNorm();
    next += 2;
  }
}

// Appends the errors of a view, and returns its measurements.
std::vector<CircleMeasurement> appendErrors(const CalibrationInput& input, const CalibrationState& state,
                                            const OptimisationOptions& options, double displacements,
                                            const CircleModel& model, std::size_t camera, std::size_t view,
                                            std::vector<CircleError>& errors) {
  const BoardView& seen = input.cameras[camera].observations.views[view];
  const std::vector<TimedCircle> within = circlesWithin(state, state.cameras[camera], seen);
  if (within.empty()) return {};
  std::vector<CircleMeasurement> circles;
  for (const TimedCircle& circle : within)
    circles.push_back(
        measurementOf(input, state, options, camera, seen.circles[circle.index], {1.0, displacements}));
  const auto [first, last] = std::ranges::minmax(within, {}, &TimedCircle::time_s);
  const SegmentTimes segments = segmentsBetween(state, first.time_s, last.time_s);
  std::vector<const double*> blocks =
      blocksOfView(state, segments, camera, camera, input.cameras[camera].board);
  std::array<double, kIntrinsicsCount> intrinsics{};
  if (model.free_intrinsics) writeIntrinsics(*state.cameras[camera].lens.solved, intrinsics.data());
  if (model.free_intrinsics) blocks.push_back(intrinsics.data());
  const ViewCost cost(model, segments, std::move(circles));
  const std::vector<double> in_sigmas = cost.errorsInSigmas(blocks.data());
  for (std::size_t i = 0; i < within.size(); ++i) {
    CircleError& error = errors.emplace_back(CircleError{camera, view, within[i].index});
    const Eigen::Vector2d of_circle(in_sigmas[2 * i], in_sigmas[2 * i + 1]);
    error.normalised2 = of_circle.squaredNorm();
    if (error.inFront())
      error.error_px = cost.circles()[i].whitening_px.triangularView<Eigen::Lower>().solve(of_circle);
    if (const auto known = onlyKnownDirection(seen.circles[within[i].index].covariance_px2)) {
      error.error_px = known->dot(error.error_px) * *known;
      error.known_directions = 1;
    }
  }
  return cost.circles();
}

// Appends the errors of a view. Circles that are used determine its displacement; null: those near the median
// error.
void appendView(const CalibrationInput& input, const CalibrationState& state,
                const OptimisationOptions& options, double displacements, const CircleModel& model,
                std::size_t camera, std::size_t view, const CircleSelection* used,
                std::vector<CircleError>& errors) {
  const std::size_t first = errors.size();
  const std::vector<CircleMeasurement> circles =
      appendErrors(input, state, options, displacements, model, camera, view, errors);
  const std::span<CircleError> of_view = std::span(errors).subspan(first);
  if (of_view.empty()) return;
  CircleFlags common;
  if (used == nullptr)
    common = nearMedian(circles, of_view, options.outlier_sigma);
  else
    for (const CircleError& error : of_view)
      common.push_back(error.inFront() && (*used)[camera][view][error.index]);
  normalise(model.modes, circles, common, of_view);
}

}  // namespace

std::vector<CircleError> circleErrors(const CalibrationInput& input, const CalibrationState& state,
                                      const OptimisationOptions& options, const NoiseScales& scales,
                                      const CircleSelection* used) {
  constexpr std::size_t kParts = 8;  // of a camera's views, for threads
  std::vector<CircleError> errors;
  for (std::size_t camera = 0; camera < input.cameras.size(); ++camera) {
    const CircleModel model{*input.cameras[camera].lens.detection_intrinsics, input.boardOf(camera).radius_m,
                            options.huber_sigma, modesOf(input, camera, options),
                            state.cameras[camera].lens.solved.has_value()};
    const std::size_t views = input.cameras[camera].observations.views.size();
    std::array<std::vector<CircleError>, kParts> parts;
    inParallel(options.threads, kParts, [&](std::size_t part) {
      const std::size_t begin = part * views / kParts, end = (part + 1) * views / kParts;
      std::size_t circles = 0;
      for (std::size_t view = begin; view < end; ++view)
        circles += input.cameras[camera].observations.views[view].circles.size();
      parts[part].reserve(circles);
      for (std::size_t view = begin; view < end; ++view)
        appendView(input, state, options, scales.displacements[camera], model, camera, view, used,
                   parts[part]);
    });
    std::size_t count = errors.size();
    for (const std::vector<CircleError>& part : parts) count += part.size();
    errors.reserve(count);
    for (const std::vector<CircleError>& part : parts) errors.insert(errors.end(), part.begin(), part.end());
  }
  return errors;
}

std::vector<CircleResidual> circleResiduals(const CalibrationInput& input,
                                            const std::vector<CircleError>& errors,
                                            const CircleSelection& used) {
  std::vector<CircleResidual> residuals;
  residuals.reserve(errors.size());
  for (const CircleError& error : errors) {
    const CircleObservation& circle =
        input.cameras[error.camera].observations.views[error.view].circles[error.index];
    residuals.push_back({static_cast<int>(error.camera), static_cast<int>(error.view), circle.circle,
                         circle.time_s, circle.centre_px, error.error_px,
                         circle.covariance_px2.diagonal().cwiseSqrt(),
                         used[error.camera][error.view][error.index] != 0});
  }
  return residuals;
}

double displacementScale(const CalibrationInput& input, const CalibrationState& state,
                         const OptimisationOptions& options, const std::vector<CircleError>& errors,
                         const CircleSelection& used, std::size_t camera) {
  const BoardObservations& observations = input.cameras[camera].observations;
  if (observations.kind != CameraKind::Events) return 1.0;
  const std::size_t step = std::max<std::size_t>(
      1, observations.views.size() / static_cast<std::size_t>(options.displacement_views));
  const FieldModes root = fieldRoot(input.boardOf(camera), options);
  FieldSize size(root, options.displacement_size_sigma);
  std::vector<FieldSize::Circle> circles;
  const auto begin = std::ranges::lower_bound(errors, camera, {}, &CircleError::camera);
  for (auto error = begin; error != errors.end() && error->camera == camera;) {
    circles.clear();
    const std::size_t view = error->view;
    for (; error != errors.end() && error->camera == camera && error->view == view; ++error) {
      if (view % step != 0 || !error->inFront() || !used[camera][view][error->index]) continue;
      const CircleObservation& observed = observations.views[view].circles[error->index];
      const CircleMeasurement m = measurementOf(input, state, options, camera, observed, {});
      circles.push_back({{m.point, m.rho / options.displacement_persistence},
                         m.centre_px,
                         m.whitening_px * error->error_px,
                         m.whitening_px});
    }
    size.add(circles);
  }
  return size.mostProbable();
}

double neighbourAgreement(const CalibrationInput& input, const CalibrationState& state,
                          const OptimisationOptions& options, const Weights& weights, std::size_t camera) {
  const CameraData& data = input.cameras[camera];
  if (data.observations.kind != CameraKind::Events) return 0.0;
  const CircleScales scales{1.0, weights.scales.displacements[camera]};
  double shares = 0.0, count = 0.0;
  for (std::size_t view = 0; view < data.observations.views.size(); ++view) {
    for (std::size_t i = 0; i < data.observations.views[view].circles.size(); ++i) {
      if (!weights.used_circles[camera][view][i]) continue;
      const CircleObservation& observed = data.observations.views[view].circles[i];
      const double rho = measurementOf(input, state, options, camera, observed, scales).rho /
                         options.displacement_persistence;
      shares += rho * rho / (1.0 + rho * rho);
      ++count;
    }
  }
  return count > 0.0
             ? shares / count * fieldCovariance(nearestPoints_spacings(input.boardOf(camera)), options)
             : 0.0;
}

double robustScale(const std::vector<CircleError>& errors, std::size_t camera) {
  std::vector<double> normalised2;
  for (const CircleError& error : errors) {
    if (error.camera == camera)
      normalised2.push_back(error.known_directions == 1 ? asOfTwoDirections(error.normalised2)
                                                        : error.normalised2);
  }
  return scaleOfPoints(std::move(normalised2));
}

CircleSelection selectCircles(const CalibrationInput& input, const std::vector<CircleError>& errors,
                              const std::vector<double>& scales, const OptimisationOptions& options) {
  CircleSelection used = allCircles(input);
  for (const CircleError& error : errors) {
    const double bound = options.outlier_sigma * scales[error.camera];
    if (!(error.normalised2 <= bound * bound)) used[error.camera][error.view][error.index] = 0;
  }
  for (auto& views : used) {
    for (auto& circles : views) {
      const auto dropped = std::count(circles.begin(), circles.end(), std::uint8_t{0});
      if (static_cast<double>(dropped) >
          options.outlier_window_fraction * static_cast<double>(circles.size())) {
        std::fill(circles.begin(), circles.end(), std::uint8_t{0});
      }
    }
  }
  return used;
}

}  // namespace evical
