#include "core/intrinsics/sensor_views.h"

#include "core/geometry/camera_model.h"

#include <Eigen/LU>

#include <cmath>

namespace evical {
namespace {

SensorCircle sensorCircle(const CircleObservation& circle, double time_s, const Board& board,
                          const std::optional<CameraIntrinsics>& detection_intrinsics,
                          const IntrinsicsOptions& options) {
  const Eigen::Vector2d ideal = circle.centre_px + (time_s - circle.time_s) * circle.velocity_px_s;
  Eigen::Matrix2d sensor_from_ideal = Eigen::Matrix2d::Identity();
  SensorCircle out;
  out.on_board_m = board.point_m(circle.circle);
  out.centre_px = ideal;
  if (detection_intrinsics) {
    out.centre_px = pixelFromIdeal(*detection_intrinsics, ideal);
    sensor_from_ideal = idealPixelScale(*detection_intrinsics, ideal).inverse();
  }
  const double floor_px2 = options.least_centre_sigma_px * options.least_centre_sigma_px;
  out.covariance_px2 = sensor_from_ideal * circle.covariance_px2 * sensor_from_ideal.transpose() +
                       floor_px2 * Eigen::Matrix2d::Identity();
  out.lead_effect = sensor_from_ideal * circle.edge_localisation_bias_effect;
  return out;
}

}  // namespace

std::vector<SensorView> sensorViews(const BoardObservations& observations, const Board& board,
                                    const std::optional<CameraIntrinsics>& detection_intrinsics,
                                    const IntrinsicsOptions& options) {
  std::vector<SensorView> views;
  const double least = std::max(4.0, options.least_circles * board.pointCount());
  for (const BoardView& view : observations.views) {
    if (static_cast<double>(view.circles.size()) < least) continue;
    SensorView& out = views.emplace_back();
    for (const CircleObservation& circle : view.circles)
      out.time_s += circle.time_s / static_cast<double>(view.circles.size());
    for (const CircleObservation& circle : view.circles)
      out.circles.push_back(sensorCircle(circle, out.time_s, board, detection_intrinsics, options));
  }
  return views;
}

}  // namespace evical
