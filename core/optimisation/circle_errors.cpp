#include "core/optimisation/circle_errors.h"

#include "core/numerics/robust.h"
#include "core/optimisation/common_displacement.h"
#include "core/optimisation/edge_localisation_bias.h"
#include "core/optimisation/free_intrinsics.h"

#include "core/geometry/circle_conic.h"
#include "core/geometry/trajectory.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

namespace evical {
namespace {

// In the ideal pixels of the observations.
std::optional<Eigen::Vector2d> predictedCentre(const CameraData& camera, const CameraState& state,
                                               const CircleObservation& circle,
                                               const RigidTransform& camera_from_world, const Board& board,
                                               const BoardState& board_state) {
  const Eigen::Vector3d in_camera_m = camera_from_world * board_state.place_m(board.point_m(circle.circle));
  const Eigen::Vector3d normal = camera_from_world.rotation * board_state.normal();
  const auto projected =
      state.lens.solved
          ? projectCircleBeside(seenCentre(*camera.lens.detection_intrinsics, circle.centre_px),
                                *state.lens.solved, in_camera_m, normal, board.radius_m)
          : projectCircle(*camera.lens.detection_intrinsics, in_camera_m, normal, board.radius_m);
  return projected ? std::optional(projected->centre_px) : std::nullopt;
}

// One circle of a view: its error, and L^-1 of its covariance L L^T.
struct ViewCircle {
  CircleError* error;
  const CircleObservation* measured;
  Eigen::Matrix2d whitening_px;
};

std::vector<ViewCircle> viewCircles(const BoardObservations& observations, const OptimisationOptions& options,
                                    std::span<CircleError> view) {
  const double floor_px2 = options.least_centre_sigma_px * options.least_centre_sigma_px;
  std::vector<ViewCircle> circles;
  for (CircleError& error : view) {
    if (!std::isfinite(error.normalised2)) continue;  // behind the camera
    const CircleObservation& measured = observations.views[error.view].circles[error.index];
    const Eigen::Matrix2d covariance = measured.covariance_px2 + floor_px2 * Eigen::Matrix2d::Identity();
    circles.push_back({&error, &measured, covariance.llt().matrixL().solve(Eigen::Matrix2d::Identity())});
  }
  return circles;
}

// Squared deviations of the errors from their median, over sigmas.
std::vector<double> deviationsFromMedian(const std::vector<ViewCircle>& circles) {
  std::vector<double> x_px, y_px, deviations2;
  for (const ViewCircle& circle : circles) {
    x_px.push_back(circle.error->error_px.x());
    y_px.push_back(circle.error->error_px.y());
  }
  const Eigen::Vector2d median_px(medianOf(std::move(x_px)), medianOf(std::move(y_px)));
  for (const ViewCircle& circle : circles)
    deviations2.push_back((circle.whitening_px * (circle.error->error_px - median_px)).squaredNorm());
  return deviations2;
}

// Errors over sigmas of one view, whitened for the displacement that its circles have in common. Circles far from the
// median take no part in the displacement.
void normalise(const BoardObservations& observations, const OptimisationOptions& options,
               std::span<CircleError> view) {
  const std::vector<ViewCircle> circles = viewCircles(observations, options, view);
  const std::vector<double> deviations2 = deviationsFromMedian(circles);
  const double bound = options.outlier_sigma * std::max(1.0, scaleOfPoints(deviations2));
  std::vector<Eigen::Index> rows;
  std::vector<Eigen::Matrix2d> roots;
  std::vector<double> whitened;
  std::vector<CircleError*> common;
  for (std::size_t i = 0; i < circles.size(); ++i) {
    const ViewCircle& circle = circles[i];
    const Eigen::Vector2d in_sigmas = circle.whitening_px * circle.error->error_px;
    circle.error->normalised2 = in_sigmas.squaredNorm();
    if (deviations2[i] > bound * bound) continue;
    common.push_back(circle.error);
    rows.push_back(static_cast<Eigen::Index>(whitened.size()));
    roots.emplace_back(commonDisplacement_px(observations.kind, *circle.measured, options) *
                       circle.whitening_px);
    whitened.insert(whitened.end(), {in_sigmas.x(), in_sigmas.y()});
  }
  if (common.empty()) return;
  CommonDisplacement(std::move(rows), roots).whiten(whitened.data(), 1);
  for (std::size_t k = 0; k < common.size(); ++k)
    common[k]->normalised2 = Eigen::Map<const Eigen::Vector2d>(&whitened[2 * k]).squaredNorm();
}

}  // namespace

std::vector<CircleError> circleErrors(const CalibrationInput& input, const CalibrationState& state,
                                      const OptimisationOptions& options) {
  std::vector<CircleError> errors;
  const So3Spline& rotation = state.world_from_imu_rotation;
  const VectorSpline& position = state.imu_in_world_m;
  for (std::size_t c = 0; c < input.cameras.size(); ++c) {
    const CameraData& camera = input.cameras[c];
    const CameraState& camera_state = state.cameras[c];
    for (std::size_t v = 0; v < camera.observations.views.size(); ++v) {
      const auto& circles = camera.observations.views[v].circles;
      const std::size_t first = errors.size();
      for (std::size_t i = 0; i < circles.size(); ++i) {
        const CircleObservation& circle = circles[i];
        const double time_s = circleTime_s(camera_state, circle);
        if (!rotation.contains(time_s) || !position.contains(time_s)) continue;
        CircleError error{c, v, i, Eigen::Vector2d::Zero(), std::numeric_limits<double>::infinity()};
        const auto centre_px =
            predictedCentre(camera, camera_state, circle,
                            cameraFromWorld(rotation, position, camera_state.reference_from_camera,
                                            time_s - circle.time_s, circle.time_s),
                            input.boardOf(c), state.boardAt(camera.board));
        if (centre_px) {
          const EdgeLocalisationBiasEffect lead =
              edgeBiasEffect(*camera.lens.detection_intrinsics, circle, options.slow_edge_speed_px_s);
          error.error_px = *centre_px + edgeBiasOf(camera_state).times(lead) - circle.centre_px;
          error.normalised2 = 0.0;
        }
        errors.push_back(error);
      }
      normalise(camera.observations, options, std::span(errors).subspan(first));
    }
  }
  return errors;
}

std::vector<CircleResidual> circleResiduals(const CalibrationInput& input, const CalibrationState& state,
                                            const CircleSelection& used, const OptimisationOptions& options) {
  const std::vector<CircleError> errors = circleErrors(input, state, options);
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

double robustScale(const std::vector<CircleError>& errors, std::size_t camera) {
  std::vector<double> normalised2;
  for (const CircleError& error : errors) {
    if (error.camera == camera) normalised2.push_back(error.normalised2);
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
