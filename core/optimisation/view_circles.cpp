#include "core/optimisation/view_circles.h"

#include "core/optimisation/circle_errors.h"
#include "core/optimisation/displacement_field.h"
#include "core/optimisation/edge_localisation_bias.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

// Index of the image's cell, of 16 x 10.
int placeOf(const Eigen::Vector2d& centre_px, const Resolution& resolution_px) {
  constexpr int kColumns = 16, kRows = 10;
  const auto cell = [](double at, int size_px, int cells) {
    return std::clamp(static_cast<int>(std::floor(at * cells / std::max(1, size_px))), 0, cells - 1);
  };
  return cell(centre_px.y(), resolution_px.height_px, kRows) * kColumns +
         cell(centre_px.x(), resolution_px.width_px, kColumns);
}

}  // namespace

std::vector<TimedCircle> circlesWithin(const CalibrationState& state, const CameraState& camera,
                                       const BoardView& view) {
  std::vector<TimedCircle> circles;
  for (std::size_t i = 0; i < view.circles.size(); ++i) {
    const double time_s = circleTime_s(camera, view.circles[i]);
    if (state.world_from_imu_rotation.contains(time_s) && state.imu_in_world_m.contains(time_s))
      circles.push_back({time_s, i});
  }
  return circles;
}

FieldModes modesOf(const CalibrationInput& input, std::size_t camera, const ModelOptions& options) {
  return input.cameras[camera].observations.kind == CameraKind::Events
             ? fieldModes(input.boardOf(camera), options)
             : FieldModes();
}

CircleMeasurement measurementOf(const CalibrationInput& input, const CalibrationState& state,
                                const ModelOptions& options, std::size_t camera,
                                const CircleObservation& observed, const CircleScales& scales) {
  const CameraData& data = input.cameras[camera];
  const CameraIntrinsics& lens = *data.lens.detection_intrinsics;
  const double floor_px2 = options.min_centre_sigma_px * options.min_centre_sigma_px;
  const Eigen::Matrix2d covariance =
      scales.circles * scales.circles * (observed.covariance_px2 + floor_px2 * Eigen::Matrix2d::Identity());
  CircleMeasurement m;
  m.time_s = observed.time_s;
  m.by_drift_s = byDrift_s(state.cameras[camera], observed.time_s);
  m.by_line_s = 1e-6 * observed.rows_below_middle;
  m.by_exposure_s = observed.longer_exposed_s;
  m.on_board_m = input.boardOf(camera).point_m(observed.circle);
  m.centre_px = observed.centre_px;
  m.whitening_px = covariance.llt().matrixL().solve(Eigen::Matrix2d::Identity());
  m.lead = edgeBiasEffect(lens, observed, options.slow_edge_speed_px_s);
  m.rho = scales.circles * scales.displacements * options.displacement_persistence *
          displacementSigma_px(data.observations.kind, observed, options) * std::sqrt(0.5) *
          m.whitening_px.norm();
  m.point = observed.circle;
  m.place = placeOf(observed.centre_px, lens.resolution_px);
  return m;
}

SegmentTimes segmentsBetween(const CalibrationState& state, double first_s, double last_s) {
  SegmentTimes segments = segmentAt(state.world_from_imu_rotation, state.imu_in_world_m, first_s);
  const SegmentTimes last = segmentAt(state.world_from_imu_rotation, state.imu_in_world_m, last_s);
  segments.rotations += last.rotation - segments.rotation;
  segments.positions += last.position - segments.position;
  return segments;
}

PixelErrors::PixelErrors(const CameraData& camera, const Board& board, double pixel_error_px)
    : mean_px_(static_cast<std::size_t>(board.pointCount()), Eigen::Vector2d::Zero()) {
  std::vector<double> counts(mean_px_.size(), 0.0);
  const auto forEach = [&](auto&& visit) {
    for (const BoardView& view : camera.observations.views)
      for (const CircleObservation& circle : view.circles)
        visit(static_cast<std::size_t>(circle.circle), circle);
  };
  forEach([&](std::size_t i, const CircleObservation& circle) {
    mean_px_[i] += (circle.centre_px - mean_px_[i]) / ++counts[i];
  });
  double sum_px2 = 0.0, count = 0.0;
  forEach([&](std::size_t i, const CircleObservation& circle) {
    sum_px2 += (circle.centre_px - mean_px_[i]).squaredNorm();
    count += 1.0;
  });
  constexpr double kOnePixel = 1.0;  // fewer are not crossed
  const double amplitude_px = std::max(kOnePixel, std::sqrt(sum_px2 / std::max(1.0, count)));
  swing_ = pixel_error_px / (amplitude_px * std::sqrt(amplitude_px));
}

Eigen::Vector2d PixelErrors::at(const CircleObservation& circle) const {
  return swing_ * (circle.centre_px - mean_px_[static_cast<std::size_t>(circle.circle)]);
}

}  // namespace evical
