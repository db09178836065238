#include "core/synthetic/scene_renderer.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <random>

namespace evical {
namespace {

constexpr int kTexture = 1024;      // texels a side, a power of two
constexpr float kEdgeReach = 4.0f;  // in sigmas of the blur
constexpr int kEdgeSteps = 512;     // of the tabulated error function, a sigma's eighth of a percent
constexpr float kMeanLogReflectance = -1.2f;

// Smooth periodic noise of unit variance: white noise, box-filtered until only structure of a few texels is
// left.
std::vector<float> makeTexture(std::uint64_t seed) {
  std::mt19937_64 generator(seed * 6364136223846793005ull + 99);
  std::normal_distribution<float> normal;
  const auto n = static_cast<std::size_t>(kTexture);
  std::vector<float> texture(n * n, 0.0f), octave(n * n), filtered(n * n);
  for (const int radius : {1, 3, 8}) {
    for (float& v : octave) v = normal(generator);
    for (int pass = 0; pass < 3; ++pass) {
      for (const bool along_x : {true, false}) {
        for (std::size_t y = 0; y < n; ++y) {
          for (std::size_t x = 0; x < n; ++x) {
            float sum = 0.0f;
            for (int d = -radius; d <= radius; ++d) {
              const std::size_t shifted = (along_x ? x : y) + n + static_cast<std::size_t>(d + kTexture);
              sum += along_x ? octave[y * n + shifted % n] : octave[(shifted % n) * n + x];
            }
            filtered[y * n + x] = sum;
          }
        }
        octave.swap(filtered);
      }
    }
    double squares = 0.0;
    for (const float v : octave) squares += static_cast<double>(v) * v;
    const auto scale =
        static_cast<float>(1.0 / std::sqrt(squares / static_cast<double>(octave.size()) * 3.0));
    for (std::size_t i = 0; i < texture.size(); ++i) texture[i] += scale * octave[i];
  }
  return texture;
}

}  // namespace

SceneRenderer::SceneRenderer(const Scenario& scenario, std::size_t index)
    : scenario_(scenario),
      width_px_(scenario.cameras[index].intrinsics.resolution_px.width_px),
      blur_px_(static_cast<float>(std::max(scenario.cameras[index].pixel.blur_px, 0.05))),
      log_bright_(static_cast<float>(std::log(scenario.scene.bright_reflectance))),
      texture_(makeTexture(scenario.seed)) {
  const CameraIntrinsics& camera = scenario.cameras[index].intrinsics;
  const UndistortionTable ideal(camera);
  const Eigen::Vector2d& f = camera.focal_length_px;
  for (int y = 0; y < camera.resolution_px.height_px; ++y) {
    for (int x = 0; x < width_px_; ++x) {
      const Eigen::Vector2d pixel = ideal(x, y).cast<double>();
      const Eigen::Vector2d ray = (pixel - camera.principal_point_px).cwiseQuotient(f);
      rays_.push_back(ray.cast<float>());
      const Eigen::Matrix2d per_px = f.cwiseInverse().asDiagonal() * idealPixelScale(camera, pixel);
      ray_per_px_.push_back(per_px.cast<float>());
    }
  }
  const double px_per_m = f.x() / (scenario.motion.distance_m + scenario.scene.clutter_distance_m);
  texels_per_m_ = static_cast<float>(2.0 * px_per_m / scenario.scene.clutter_detail_px);
  for (int i = 0; i <= kEdgeSteps; ++i) {
    const double sigmas = (2.0 * i / kEdgeSteps - 1.0) * kEdgeReach;
    edge_table_.push_back(static_cast<float>(0.5 * std::erfc(-sigmas / std::sqrt(2.0))));
  }
}

SceneRenderer::Instant SceneRenderer::at(const RigidTransform& world_from_camera) const {
  const RigidTransform camera_from_world = inverse(world_from_camera);
  const Eigen::Matrix3d r = camera_from_world.rotation.toRotationMatrix();
  const auto planeFromRay = [&](double depth_m) {
    Eigen::Matrix3d h;
    h << r.col(0), r.col(1), camera_from_world.translation_m + depth_m * r.col(2);
    return Eigen::Matrix3f(h.inverse().cast<float>());
  };
  return {planeFromRay(0.0), planeFromRay(scenario_.scene.clutter_distance_m),
          world_from_camera.translation_m.cast<float>()};
}

float SceneRenderer::edge(float distance_px) const {
  const float place = (distance_px / (blur_px_ * kEdgeReach) + 1.0f) * (0.5f * kEdgeSteps);
  if (!(place > 0.0f)) return 0.0f;
  if (place >= static_cast<float>(kEdgeSteps)) return 1.0f;
  const int i = static_cast<int>(place);
  const float part = place - static_cast<float>(i);
  return edge_table_[static_cast<std::size_t>(i)] * (1.0f - part) +
         edge_table_[static_cast<std::size_t>(i) + 1] * part;
}

float SceneRenderer::background(float x_m, float y_m) const {
  const float contrast = static_cast<float>(scenario_.scene.clutter_contrast);
  if (contrast <= 0.0f) return kMeanLogReflectance;
  const float u = x_m * texels_per_m_ + 65536.0f, v = y_m * texels_per_m_ + 65536.0f;
  const int iu = static_cast<int>(u), iv = static_cast<int>(v);
  const float fu = u - static_cast<float>(iu), fv = v - static_cast<float>(iv);
  const auto texel = [&](int a, int b) {
    return texture_[static_cast<std::size_t>((b & (kTexture - 1)) * kTexture + (a & (kTexture - 1)))];
  };
  const float value = (1.0f - fv) * ((1.0f - fu) * texel(iu, iv) + fu * texel(iu + 1, iv)) +
                      fv * ((1.0f - fu) * texel(iu, iv + 1) + fu * texel(iu + 1, iv + 1));
  return kMeanLogReflectance + contrast * value;
}

float SceneRenderer::logIntensity(const Instant& instant, int x_px, int y_px) const {
  const auto pixel = static_cast<std::size_t>(y_px * width_px_ + x_px);
  const Eigen::Vector2f& ray = rays_[pixel];
  const Eigen::Vector3f b = instant.board_from_ray * ray.homogeneous();
  const auto clutter = [&] {
    const Eigen::Vector3f back = instant.background_from_ray * ray.homogeneous();
    return background(back.x() / back.z(), back.y() / back.z());
  };
  if (!(b.z() > 0.0f)) return clutter();
  const float x = b.x() / b.z(), y = b.y() / b.z();
  const CircleBoard& board = scenario_.board;
  const auto spacing = static_cast<float>(board.spacing_m), radius = static_cast<float>(board.radius_m);
  const auto margin = static_cast<float>(scenario_.scene.margin_m);
  const bool asymmetric = board.type == BoardType::AsymmetricCircles;
  const float last_x = spacing * static_cast<float>(asymmetric ? 2 * board.cols - 1 : board.cols - 1);
  const float last_y = spacing * static_cast<float>(board.rows - 1);
  // How many metres on the board a pixel is wide, along a direction on the board.
  const Eigen::Matrix2f board_per_ray = (instant.board_from_ray.topLeftCorner<2, 2>() -
                                         Eigen::Vector2f(x, y) * instant.board_from_ray.block<1, 2>(2, 0)) /
                                        b.z();
  const Eigen::Matrix2f board_per_px = board_per_ray * ray_per_px_[pixel];
  const auto metresPerPixel = [&](const Eigen::Vector2f& direction) {
    return (board_per_px.transpose() * direction).norm();
  };
  const float per_px_x = metresPerPixel(Eigen::Vector2f::UnitX()),
              per_px_y = metresPerPixel(Eigen::Vector2f::UnitY());
  const float inside_px = std::min(std::min(x + margin, last_x + margin - x) / per_px_x,
                                   std::min(y + margin, last_y + margin - y) / per_px_y);
  const float on_board = edge(inside_px);
  if (on_board <= 0.0f) return clutter();
  // The nearest circle.
  const int row = std::clamp(static_cast<int>(std::lround(y / spacing)), 0, board.rows - 1);
  float circle_coverage = 0.0f;
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, board.rows - 1); ++r) {
    const float shift = asymmetric ? static_cast<float>(r % 2) : 0.0f;
    const float column_spacing = asymmetric ? 2.0f : 1.0f;
    const int col =
        std::clamp(static_cast<int>(std::lround((x / spacing - shift) / column_spacing)), 0, board.cols - 1);
    const Eigen::Vector2f away(x - (column_spacing * static_cast<float>(col) + shift) * spacing,
                               y - static_cast<float>(r) * spacing);
    const float distance = away.norm();
    if (distance > 2.0f * radius) continue;
    const float per_px = distance > 1e-7f ? metresPerPixel(away / distance) : per_px_x;
    circle_coverage = std::max(circle_coverage, edge((radius - distance) / per_px));
  }
  const bool dark = board.circles == CircleShade::Dark;
  const auto bright = static_cast<float>(scenario_.scene.bright_reflectance);
  const auto black = static_cast<float>(scenario_.scene.dark_reflectance);
  if (on_board >= 1.0f && circle_coverage <= 0.0f && dark) return log_bright_;
  const float paper = dark ? bright : black, ink = dark ? black : bright;
  const float reflectance = paper + (ink - paper) * circle_coverage;
  if (on_board >= 1.0f) return std::log(reflectance);
  return std::log(on_board * reflectance + (1.0f - on_board) * std::exp(clutter()));
}

}  // namespace evical
