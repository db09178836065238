#include "tests/support/moving_camera.h"

#include "core/base/time.h"
#include "core/egomotion/camera_record.h"
#include "core/egomotion/egomotion_options.h"
#include "core/egomotion/window_fit.h"
#include "tests/support/random_vector.h"

#include <cmath>

namespace evical::test {

CameraIntrinsics davisLens() {
  CameraIntrinsics lens;
  lens.resolution_px = {346, 260};
  lens.focal_length_px = {262.4, 262.9};
  lens.principal_point_px = {171.8, 131.2};
  lens.distortion = {-0.33, 0.11, 0.0006, -0.0004};
  return lens;
}

EgomotionOptions quickEgomotion() {
  EgomotionOptions options;
  options.window_s = 0.08;
  options.min_slopes = 60;
  options.depth_columns = 3;
  options.depth_rows = 2;
  return options;
}

std::vector<EdgeSlope> edgeSlopes(const MovingCamera& camera, const LensRays& lens, double begin_s,
                                  double duration_s, std::mt19937& generator) {
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::normal_distribution<double> normal;
  std::vector<EdgeSlope> slopes;
  constexpr double kMinSpeed_px_s = 20.0;
  // A camera at rest has none.
  for (int tried = 0; tried < 20 * camera.slopes && static_cast<int>(slopes.size()) < camera.slopes;
       ++tried) {
    const int x = static_cast<int>(346 * part(generator)), y = static_cast<int>(260 * part(generator));
    const double time_s = begin_s + duration_s * part(generator);
    const LensRays::Ray& ray = lens.at(x, y);
    const Eigen::Vector2d place = ray.place.cast<double>();
    const double nearness_1_m = (x / 44 + y / 44) % 2 == 0 ? camera.nearest_1_m : camera.further_1_m;
    const Eigen::Vector2d flow = ray.px_per_place.cast<double>() *
                                 (rotationalMotion(place) * camera.rate_rad_s(time_s) +
                                  nearness_1_m * (translationalMotion(place) * camera.velocity_m_s(time_s)));
    const double angle = 6.2831853 * part(generator);
    const Eigen::Vector2d edge(std::cos(angle), std::sin(angle));
    const double speed = edge.dot(flow);
    if (std::abs(speed) < kMinSpeed_px_s) continue;
    Eigen::Vector2d slope = edge / speed;
    const double sigma = camera.noise * slope.norm();
    slope += sigma * test::randomVector<2>([&] { return normal(generator); });
    EdgeSlope& out = slopes.emplace_back();
    out.time_ns = nanosecondsFrom(time_s);
    out.x_px = static_cast<std::uint16_t>(x);
    out.y_px = static_cast<std::uint16_t>(y);
    out.slope_s_px = slope.cast<float>();
    out.shape = {1.0f / 50.0f, 0.0f, 1.0f / 50.0f};
  }
  return slopes;
}

CameraRecord cameraRecord(const MovingCamera& camera, const LensRays& lens, double begin_s, double end_s,
                          const EgomotionOptions& options, unsigned seed) {
  std::mt19937 generator(seed);
  CameraRecord record;
  for (double from_s = begin_s; from_s + options.window_s < end_s; from_s += options.window_s) {
    const std::vector<EdgeSlope> slopes = edgeSlopes(camera, lens, from_s, options.window_s, generator);
    const std::int64_t begin_ns = nanosecondsFrom(from_s);
    record.windows.push_back(estimateWindowMotion(slopes, lens, {0, begin_ns}, options));
    if (record.windows.back().use == WindowUse::Used)
      record.slopes.add(record.windows.size() - 1, begin_ns, slopes, options);
  }
  return record;
}

}  // namespace evical::test
