#include "core/synthetic/scene_renderer.h"

#include "core/geometry/camera_model.h"
#include "core/geometry/printed_pattern.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace evical {
namespace {

constexpr int kEdgeSteps = 512;  // of the tabulated error function

// Texels of the clutter per pixel, at the motion's mean distance.
double texelsPerPixel(const Scenario& scenario) {
  constexpr double kTexelsOfDetail = 2.0;
  return kTexelsOfDetail / scenario.scene.clutter_detail_px;
}

ClutterTextureOptions textureOptions(const Scenario& scenario, std::size_t camera) {
  // In a room this picture is not visible; a uniform one saves time.
  const double contrast = scenario.room.exists() ? 0.0 : scenario.scene.clutter_contrast;
  return {scenario.seed,
          contrast,
          scenario.scene.clutter_object_share,
          scenario.scene.clutter_round_share,
          scenario.scene.clutter_squares_px * texelsPerPixel(scenario),
          scenario.cameras[camera].pixel.effectiveBlur_px() * texelsPerPixel(scenario)};
}

// The matrix's largest singular value.
float largestStretch(const Eigen::Matrix2f& matrix) {
  const float half_trace = 0.5f * matrix.squaredNorm(), determinant = matrix.determinant();
  return std::sqrt(half_trace +
                   std::sqrt(std::max(half_trace * half_trace - determinant * determinant, 0.0f)));
}

}  // namespace

// d(plane)/d(ray) at a ray that meets the plane at `point`, `depth` being the homography's third coordinate.
Eigen::Matrix2f SceneRenderer::planeDerivative(const Eigen::Matrix3f& plane_from_ray,
                                               const Eigen::Vector2f& point, float depth) {
  return (plane_from_ray.topLeftCorner<2, 2>() - point * plane_from_ray.block<1, 2>(2, 0)) / depth;
}

SceneRenderer::SceneRenderer(const Scenario& scenario, std::size_t index)
    : scenario_(scenario),
      board_(scenario.board),
      surface_(scenario),
      row_spacing_m_((1.0 + scenario.board_stretch) * scenario.board.spacing_m),
      scene_(scenario.scene),
      is_visited_(scene_.gloss.strength > 0.0 || scene_.hand.every_s > 0.0 || scene_.people.every_s > 0.0),
      width_px_(scenario.cameras[index].intrinsics.resolution_px.width_px),
      height_px_(scenario.cameras[index].intrinsics.resolution_px.height_px),
      blur_px_(static_cast<float>(scenario.cameras[index].pixel.effectiveBlur_px())),
      texture_(textureOptions(scenario, index)) {
  const CameraIntrinsics& camera = scenario.cameras[index].intrinsics;
  const bool dark = board_.circles == CircleShade::Dark;
  paper_ = static_cast<float>(dark ? scene_.bright_reflectance : scene_.dark_reflectance);
  ink_ = static_cast<float>(dark ? scene_.dark_reflectance : scene_.bright_reflectance);
  log_paper_ = std::log(paper_);
  log_ink_ = std::log(ink_);
  const bool asymmetric = board_.type == BoardType::AsymmetricCircles;
  const Eigen::Vector2d last(board_.spacing_m * (asymmetric ? 2 * board_.cols - 1 : board_.cols - 1),
                             row_spacing_m_ * (board_.rows - 1));
  board_low_m_ = Eigen::Vector2d::Constant(-scene_.margin_m).cast<float>();
  board_high_m_ = (last.array() + scene_.margin_m).matrix().cast<float>();
  if (!board_.hasCircles()) layBoxes(scenario);
  const UndistortionTable ideal(camera);
  const Eigen::Vector2d f = idealFocalLength_px(camera);
  for (int y = 0; y < height_px_; ++y) {
    for (int x = 0; x < width_px_; ++x) {
      const Eigen::Vector2d pixel = ideal(x, y).cast<double>();
      rays_.push_back((pixel - camera.principal_point_px).cwiseQuotient(f).cast<float>());
      const Eigen::Matrix2d per_px = f.cwiseInverse().asDiagonal() * idealPixelScale(camera, pixel);
      ray_per_px_.push_back(per_px.cast<float>());
    }
  }
  const Eigen::Vector2d middle_m = 0.5 * board_.extent_m();
  lamp_m_ = (Eigen::Vector3d(middle_m.x(), middle_m.y(), 0.0) + scene_.lamp_m).cast<float>();
  shadow_sigma_m_ = static_cast<float>(
      std::hypot(scene_.hand.shadow_edge_m, blur_px_ * scenario.motion.distance_m / f.x()));
  const double px_per_m = f.x() / (scenario.motion.distance_m + scene_.clutter_distance_m);
  texels_per_m_ = static_cast<float>(texelsPerPixel(scenario) * px_per_m);
  for (int i = 0; i <= kEdgeSteps; ++i) {
    const double sigmas = (2.0 * i / kEdgeSteps - 1.0) * kEdgeReach;
    edge_table_.push_back(static_cast<float>(0.5 * std::erfc(-sigmas / std::sqrt(2.0))));
  }
}

void SceneRenderer::layBoxes(const Scenario& scenario) {
  const Eigen::Vector2d stretch(1.0, 1.0 + scenario.board_stretch);
  for (const PaintedBox& box : PrintedPattern(board_, scenario.tag_print).inkBoxes())
    boxes_.push_back({box.corner_m.cwiseProduct(stretch).cast<float>(),
                      (box.corner_m + box.size_m).cwiseProduct(stretch).cast<float>()});
  const double beyond_m = board_.printBeyond_m() + scene_.margin_m;
  board_low_m_ = Eigen::Vector2d::Constant(-beyond_m).cast<float>();
  board_high_m_ = (board_.extent_m().cwiseProduct(stretch).array() + beyond_m).matrix().cast<float>();
}

// Homography of the plane at this distance behind the board's.
Eigen::Matrix3f SceneRenderer::planeFromRay(const RigidTransform& camera_from_world, double depth_m) {
  const Eigen::Matrix3d r = camera_from_world.rotation.toRotationMatrix();
  Eigen::Matrix3d h;
  h << r.col(0), r.col(1), camera_from_world.translation_m + depth_m * r.col(2);
  return h.inverse().cast<float>();
}

SceneRenderer::Instant SceneRenderer::at(const RigidTransform& world_from_camera, double time_s) const {
  const RigidTransform camera_from_world = inverse(world_from_camera);
  Instant instant{planeFromRay(camera_from_world, 0.0),
                  planeFromRay(camera_from_world, scene_.clutter_distance_m),
                  world_from_camera.translation_m.cast<float>()};
  if (is_visited_) instant.figures = figuresAt(camera_from_world, time_s);
  return instant;
}

SceneRenderer::Tile SceneRenderer::tile(int column, int row) const {
  const int x = column * kTile_px, y = row * kTile_px;
  return {x, y, std::min(kTile_px, width_px_ - x), std::min(kTile_px, height_px_ - y)};
}

// Motion of a pixel's content away from it, on the board and on the background.
float SceneRenderer::travel(std::size_t pixel, const Instants& instants) const {
  const Eigen::Vector3f ray = rays_[pixel].homogeneous();
  float farthest = 0.0f;
  for (const auto plane : {&Instant::board_from_ray, &Instant::background_from_ray}) {
    float path = 0.0f;
    for (int half = 0; half < 2; ++half) {
      const Eigen::Matrix3f& before = instants[static_cast<std::size_t>(half)]->*plane;
      const Eigen::Matrix3f& after = instants[static_cast<std::size_t>(half) + 1]->*plane;
      const Eigen::Vector3f from = before * ray, to = after * ray;
      if (!(from.z() > 0.0f) || !(to.z() > 0.0f)) continue;
      const Eigen::Vector2f shift_m = to.hnormalized() - from.hnormalized();
      const Eigen::Matrix2f per_px =
          planeDerivative(before, from.hnormalized(), from.z()) * ray_per_px_[pixel];
      const float length = (per_px.inverse() * shift_m).norm();
      if (std::isfinite(length)) path += length;
    }
    farthest = std::max(farthest, path);
  }
  return farthest;
}

void SceneRenderer::findCircles(const Eigen::Vector2f& low_m, const Eigen::Vector2f& high_m,
                                TileView& view) const {
  const auto spacing = static_cast<float>(row_spacing_m_), radius = static_cast<float>(board_.radius_m);
  const int first = std::max(0, static_cast<int>(std::ceil((low_m.y() - radius) / spacing)));
  const int last = std::min(board_.rows - 1, static_cast<int>(std::floor((high_m.y() + radius) / spacing)));
  for (int row = first; row <= last; ++row) {
    for (int col = 0; col < board_.cols; ++col) {
      const Eigen::Vector2f centre(static_cast<float>(board_.point_m(row, col).x()),
                                   static_cast<float>(row_spacing_m_ * row));
      const Eigen::Vector2f nearest = centre.cwiseMax(low_m).cwiseMin(high_m);
      if ((nearest - centre).norm() < radius) view.circles_m.push_back(centre);
    }
  }
}

void SceneRenderer::findBoxes(const Eigen::Vector2f& low_m, const Eigen::Vector2f& high_m,
                              TileView& view) const {
  for (const InkBox& box : boxes_)
    if ((box.low_m.array() < high_m.array()).all() && (box.high_m.array() > low_m.array()).all())
      view.boxes.push_back(box);
}

void SceneRenderer::look(const Tile& tile, const Instants& instants, TileView& view) const {
  lookAtPlanes(tile, instants, view);
  if (is_visited_) lookForVisits(tile, instants, view);
}

void SceneRenderer::lookAtPlanes(const Tile& tile, const Instants& instants, TileView& view) const {
  view.content = Content::Mixed;
  view.constant = false;
  view.travel_px = 0.0f;
  view.circles_m.clear();
  view.boxes.clear();
  Eigen::Vector2f low = Eigen::Vector2f::Constant(std::numeric_limits<float>::max()), high = -low;
  float metres_per_px = 0.0f;
  bool visible = true;
  for (const int y : {tile.y_px, tile.y_px + tile.height_px - 1}) {
    for (const int x : {tile.x_px, tile.x_px + tile.width_px - 1}) {
      const auto pixel = static_cast<std::size_t>(y * width_px_ + x);
      view.travel_px = std::max(view.travel_px, travel(pixel, instants));
      for (const Instant* instant : instants) {
        const Eigen::Vector3f b = instant->board_from_ray * rays_[pixel].homogeneous();
        visible = visible && b.z() > 0.0f;
        if (!visible) continue;
        Eigen::Vector2f point = b.hnormalized();
        Eigen::Matrix2f per_px = planeDerivative(instant->board_from_ray, point, b.z()) * ray_per_px_[pixel];
        if (surface_.isBent()) bend(*instant, point, per_px);
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
        metres_per_px = std::max(metres_per_px, largestStretch(per_px));
      }
    }
  }
  constexpr float kSlack = 1.1f;  // allows for different pixel sizes within a tile
  // Corners represent their tile to within a pixel, and three instants all times between them to within half
  // the motion.
  const float reach = (kEdgeReach * blur_px_ + 1.0f + 0.5f * view.travel_px) * metres_per_px;
  view.reach_m = visible ? kSlack * kEdgeReach * blur_px_ * metres_per_px : std::numeric_limits<float>::max();
  if (!visible) low = board_low_m_, high = board_high_m_;
  const Eigen::Array2f low_reach = low.array() - reach, high_reach = high.array() + reach;
  if (boxes_.empty())
    findCircles(low_reach.matrix(), high_reach.matrix(), view);
  else
    findBoxes(low_reach.matrix(), high_reach.matrix(), view);
  if (!visible) return;
  if ((high_reach < board_low_m_.array()).any() || (low_reach > board_high_m_.array()).any()) {
    view.content = Content::Clutter;
    view.constant = scene_.clutter_contrast <= 0.0;
  } else if ((low_reach > board_low_m_.array()).all() && (high_reach < board_high_m_.array()).all()) {
    view.constant = view.circles_m.empty() && view.boxes.empty();
    view.content = view.constant ? Content::Paper : Content::Pattern;
  }
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

float SceneRenderer::clutter(const Instant& instant, const Eigen::Vector2f& ray) const {
  const Eigen::Matrix3f& h = instant.background_from_ray;
  const float depth = h(2, 0) * ray.x() + h(2, 1) * ray.y() + h(2, 2);
  const float scale = depth > 0.0f ? texels_per_m_ / depth : 0.0f;
  return texture_((h(0, 0) * ray.x() + h(0, 1) * ray.y() + h(0, 2)) * scale,
                  (h(1, 0) * ray.x() + h(1, 1) * ray.y() + h(1, 2)) * scale);
}

// Share of a pixel on the sheet.
float SceneRenderer::sheet(const Eigen::Vector2f& point_m, const Eigen::Matrix2f& board_per_px) const {
  const Eigen::Vector2f inside_m = (point_m - board_low_m_).cwiseMin(board_high_m_ - point_m);
  const float inside_px =
      std::min(inside_m.x() / board_per_px.row(0).norm(), inside_m.y() / board_per_px.row(1).norm());
  return std::isfinite(inside_px) ? edge(inside_px) : 0.0f;
}

// Share of a pixel in the ink of the circle whose centre is `away` from it. Blur by sigma reduces the
// apparent radius of a disk by sigma^2 / (2 radius): the second order of the Gaussian's convolution with a
// curved edge.
float SceneRenderer::disk(const Eigen::Vector2f& away_m, const Eigen::Matrix2f& board_per_px) const {
  const auto radius = static_cast<float>(board_.radius_m);
  const float distance = away_m.norm();
  const Eigen::Vector2f outwards =
      distance > 1e-7f ? Eigen::Vector2f(away_m / distance) : Eigen::Vector2f::UnitX();
  const float metres_per_px = (board_per_px.transpose() * outwards).norm();
  const float shrunk_px = 0.5f * blur_px_ * blur_px_ * metres_per_px / radius;
  return edge((radius - distance) / metres_per_px - shrunk_px);
}

// Share of a pixel in the ink of squares: exact along their edges; within the blur of a corner of a tilted
// board, approximate.
float SceneRenderer::inkOf(const Eigen::Vector2f& point_m, const Eigen::Matrix2f& board_per_px,
                           const TileView& view) const {
  const float x_px_per_m = 1.0f / board_per_px.row(0).norm(), y_px_per_m = 1.0f / board_per_px.row(1).norm();
  const float reach_px = kEdgeReach * blur_px_;
  // Share of a strip from low to high.
  const auto within = [&](float from_low_px, float from_high_px) {
    return (from_low_px >= reach_px ? 1.0f : edge(from_low_px)) -
           (from_high_px <= -reach_px ? 0.0f : edge(from_high_px));
  };
  float ink = 0.0f;
  for (const InkBox& box : view.boxes) {
    const float left_px = (point_m.x() - box.low_m.x()) * x_px_per_m,
                right_px = (point_m.x() - box.high_m.x()) * x_px_per_m;
    if (left_px <= -reach_px || right_px >= reach_px) continue;
    const float above_px = (point_m.y() - box.low_m.y()) * y_px_per_m,
                below_px = (point_m.y() - box.high_m.y()) * y_px_per_m;
    if (above_px <= -reach_px || below_px >= reach_px) continue;
    ink += within(left_px, right_px) * within(above_px, below_px);
  }
  return std::min(ink, 1.0f);
}

// From a pixel's place on the plane to its place on the sheet.
void SceneRenderer::bend(const Instant& instant, Eigen::Vector2f& point_m,
                         Eigen::Matrix2f& board_per_px) const {
  const BoardSurface::Hit hit = surface_.hit(point_m, instant.camera_m);
  point_m = hit.point_m;
  board_per_px = (hit.stretch * board_per_px).eval();
}

// Half of all computing time: flat boards skip the code for bent ones, and plain scenes the code for visits.
template <bool kBent>
[[gnu::always_inline]] inline SceneRenderer::BoardPart SceneRenderer::partOf(const Instant& instant,
                                                                             std::size_t pixel,
                                                                             const TileView& view) const {
  const Eigen::Vector2f& ray = rays_[pixel];
  const Eigen::Matrix3f& h = instant.board_from_ray;
  const float depth = h(2, 0) * ray.x() + h(2, 1) * ray.y() + h(2, 2);
  if (!(depth > 0.0f)) return {};
  const float inverse_depth = 1.0f / depth;
  const Eigen::Vector2f on_plane((h(0, 0) * ray.x() + h(0, 1) * ray.y() + h(0, 2)) * inverse_depth,
                                 (h(1, 0) * ray.x() + h(1, 1) * ray.y() + h(1, 2)) * inverse_depth);
  const Eigen::Vector2f point =
      surface_.isBent() ? surface_.hit(on_plane, instant.camera_m).point_m : on_plane;
  const auto boardPerPixel = [&] {
    Eigen::Matrix2f per_px = planeDerivative(h, on_plane, depth) * ray_per_px_[pixel];
    if constexpr (kBent) {
      Eigen::Vector2f place = on_plane;
      bend(instant, place, per_px);
    }
    return per_px;
  };
  float on_board = 1.0f;
  if (view.content == Content::Mixed) {
    const float inside_m = (point - board_low_m_).cwiseMin(board_high_m_ - point).minCoeff();
    if (inside_m < -view.reach_m) return {};
    if (inside_m < view.reach_m) on_board = sheet(point, boardPerPixel());
    if (on_board <= 0.0f) return {};
  }
  const auto radius = static_cast<float>(board_.radius_m);
  const float outer = radius + view.reach_m, inner = std::max(radius - view.reach_m, 0.0f);
  float ink = 0.0f;
  for (const Eigen::Vector2f& centre : view.circles_m) {
    const Eigen::Vector2f away = point - centre;
    const float square = away.squaredNorm();
    if (square >= outer * outer) continue;
    ink = square < inner * inner ? 1.0f : std::max(ink, disk(away, boardPerPixel()));
  }
  if (!view.boxes.empty()) ink = inkOf(point, boardPerPixel(), view);
  return {on_board, ink, point};
}

SceneRenderer::BoardPart SceneRenderer::boardPart(const Instant& instant, std::size_t pixel,
                                                  const TileView& view) const {
  return surface_.isBent() ? partOf<true>(instant, pixel, view) : partOf<false>(instant, pixel, view);
}

// The board's part of a pixel and, beyond the sheet, the clutter's.
template <bool kBent>
float SceneRenderer::onBoard(const Instant& instant, std::size_t pixel, const TileView& view) const {
  const auto [on_board, ink, point] = partOf<kBent>(instant, pixel, view);
  if (on_board <= 0.0f) return clutter(instant, rays_[pixel]);
  if (on_board >= 1.0f && (ink <= 0.0f || ink >= 1.0f)) return ink <= 0.0f ? log_paper_ : log_ink_;
  const float reflectance = paper_ + (ink_ - paper_) * ink;
  if (on_board >= 1.0f) return std::log(reflectance);
  return std::log(on_board * reflectance + (1.0f - on_board) * std::exp(clutter(instant, rays_[pixel])));
}

void SceneRenderer::render(const Instant& instant, const Tile& tile, const TileView& view,
                           float* log_intensity) const {
  if (view.isVisited()) return renderVisited(instant, tile, view, log_intensity);
  for (int y = tile.y_px; y < tile.y_px + tile.height_px; ++y) {
    auto pixel = static_cast<std::size_t>(y * width_px_ + tile.x_px);
    for (int x = 0; x < tile.width_px; ++x, ++pixel, ++log_intensity) {
      switch (view.content) {
        case Content::Paper:
          *log_intensity = log_paper_;
          break;
        case Content::Clutter:
          *log_intensity = clutter(instant, rays_[pixel]);
          break;
        case Content::Pattern:
        case Content::Mixed:
          *log_intensity =
              surface_.isBent() ? onBoard<true>(instant, pixel, view) : onBoard<false>(instant, pixel, view);
          break;
      }
    }
  }
}

}  // namespace evical
