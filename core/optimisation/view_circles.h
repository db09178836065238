// Circles of a view as the batch sees them: their measurements, and the blocks of their cost function. The
// solution, its weights and its residuals use the same ones.
#pragma once

#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/view_cost.h"

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/geometry/spline_segment.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace evical {

// Shift of a time by each ppm of drift.
template <class Sensor>
double byDrift_s(const Sensor& sensor, double time_s) {
  return 1e-6 * (time_s - sensor.time_offset_at_s);
}

struct TimedCircle {
  double time_s = 0.0;
  std::size_t index = 0;  // in the view's list
};
// Circles within the range of both splines, in order of the list.
std::vector<TimedCircle> circlesWithin(const CalibrationState& state, const CameraState& camera,
                                       const BoardView& view);

// Empty for cameras without such a displacement.
FieldModes modesOf(const CalibrationInput& input, std::size_t camera, const ModelOptions& options);

// Factors of a camera's sigmas, and of those of its displacement field.
struct CircleScales {
  double circles = 1.0, displacements = 1.0;
};
// Without pixel errors.
CircleMeasurement measurementOf(const CalibrationInput& input, const CalibrationState& state,
                                const ModelOptions& options, std::size_t camera,
                                const CircleObservation& observed, const CircleScales& scales);

// All segments between these times.
SegmentTimes segmentsBetween(const CalibrationState& state, double first_s, double last_s);

// Blocks of a ViewCost, without intrinsics. `sensor`: the camera with the blocks of quantities that cameras
// share.
template <class State>
auto blocksOfView(State& state, const SegmentTimes& segments, std::size_t camera, std::size_t sensor,
                  std::size_t board) {
  auto& own = state.cameras[camera];
  auto& shared = state.cameras[sensor];
  auto& sheet = state.boardAt(board);
  std::vector<decltype(&own.time_offset_s)> blocks;
  const auto turns = state.world_from_imu_rotation.control_points.begin() + segments.rotation;
  for (auto point = turns; point != turns + 3 + segments.rotations; ++point)
    blocks.push_back(point->coeffs().data());
  const auto shifts = state.imu_in_world_m.control_points.begin() + segments.position;
  for (auto point = shifts; point != shifts + 3 + segments.positions; ++point)
    blocks.push_back(point->data());
  blocks.insert(
      blocks.end(),
      {shared.reference_from_camera.rotation.coeffs().data(),
       shared.reference_from_camera.translation_m.data(), &own.time_offset_s, &shared.time_offset_drift_ppm,
       &own.line_delay_us, &own.edge_localisation_bias_px, &own.slow_edge_localisation_bias_px, &sheet.scale,
       &sheet.stretch, &sheet.row_curvature_1_m, &sheet.column_curvature_1_m, &sheet.twist_1_m,
       &own.exposure_share, sheet.world_from_board.rotation.coeffs().data(),
       sheet.world_from_board.translation_m.data()});
  return blocks;
}

// Errors of edges that repeat whenever an edge crosses the same pixel again: no residual shows them and
// no number of views averages them. Circles that cross few pixels show a wrong amplitude by them: a
// change in proportion to the centre's distance from its mean place, of pixel_error / a^1.5 with a the
// RMS of these distances in pixels, as many independent errors as pixels. Not estimated, only allowed
// for in the reported sigmas.
class PixelErrors {
 public:
  PixelErrors(const CameraData& camera, const Board& board, double pixel_error_px);

  // Change of the circle's centre by one sigma; ideal pixels.
  Eigen::Vector2d at(const CircleObservation& circle) const;

 private:
  std::vector<Eigen::Vector2d> mean_px_;  // by circle of the board
  double swing_ = 0.0;                    // relative
};

}  // namespace evical
