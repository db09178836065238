#include "core/egomotion/edge_row.h"

#include "core/base/time.h"

#include <cmath>

namespace evical {

ImageMotion rotationalMotion(const Eigen::Vector2d& place) {
  const double x = place.x(), y = place.y();
  ImageMotion motion;
  motion << x * y, -(1.0 + x * x), y, 1.0 + y * y, -x * y, -x;
  return motion;
}

ImageMotion translationalMotion(const Eigen::Vector2d& place) {
  ImageMotion motion;
  motion << -1.0, 0.0, place.x(), 0.0, -1.0, place.y();
  return motion;
}

std::vector<EdgeRow> edgeRows(std::span<const EdgeSlope> slopes, const LensRays& lens, std::int64_t begin_ns,
                              const EgomotionOptions& options) {
  std::vector<EdgeRow> rows;
  rows.reserve(slopes.size());
  const Resolution size = lens.resolution_px();
  const std::size_t step = 1 + slopes.size() / static_cast<std::size_t>(options.most_slopes);
  for (std::size_t k = 0; k < slopes.size(); k += step) {
    const EdgeSlope& slope = slopes[k];
    const LensRays::Ray& ray = lens.at(slope.x_px, slope.y_px);
    if (!ray.known) continue;
    EdgeRow& row = rows.emplace_back();
    const Eigen::Matrix2d px_per_place = ray.px_per_place.cast<double>();
    const Eigen::Vector2d place = ray.place.cast<double>();
    row.slope = px_per_place.transpose() * slope.slope_s_px.cast<double>();
    const double time_s = options.time_noise_s,
                 passing_s = options.place_noise_px * static_cast<double>(slope.slope_s_px.norm());
    row.variance = (time_s * time_s + passing_s * passing_s) *
                   (px_per_place.transpose() * slope.covarianceAt1s() * px_per_place);
    const int column = slope.x_px * options.depth_columns / size.width_px,
              line = slope.y_px * options.depth_rows / size.height_px;
    row.patch = static_cast<std::size_t>(line * options.depth_columns + column);
    row.time_s = secondsSince(begin_ns, slope.time_ns);
    row.by_rotation = rotationalMotion(place);
    row.by_translation = translationalMotion(place);
  }
  return rows;
}

EdgeResidual edgeResidual(const EdgeRow& row, const Eigen::Vector3d& rate_rad_s,
                          const Eigen::Vector3d& velocity_1_s) {
  EdgeResidual out;
  out.translational = row.by_translation * velocity_1_s;
  const Eigen::Vector2d flow = row.by_rotation * (row.known_rate_rad_s + rate_rad_s) + out.translational;
  const Eigen::Vector2d noisy = row.variance * flow;
  constexpr double kLeastVariance = 1e-12;
  const double sigma = std::sqrt(flow.dot(noisy) + row.depth_variance + kLeastVariance);
  out.error = row.slope.dot(flow) - 1.0;
  out.value = out.error / sigma;
  out.by_flow = row.slope / sigma - out.error / (sigma * sigma * sigma) * noisy;
  return out;
}

}  // namespace evical
