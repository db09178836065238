#include "core/synthetic/room_renderer.h"

#include "core/geometry/camera_model.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace evical {
namespace {

constexpr int kBlurs = 5;
constexpr double kSharpest_texels = 0.5;

// Approximation of a step blurred by a Gaussian: a cubic of the same variance, 0 to 1 within this many sigmas
// to either side.
constexpr float kStepReach = 2.236f;

float blurredStep(float sigmas) {
  const float u = std::clamp(0.5f + 0.5f * sigmas / kStepReach, 0.0f, 1.0f);
  return u * u * (3.0f - 2.0f * u);
}

Eigen::Matrix3f sideFromRay(const RoomSide& side, const RigidTransform& camera_from_world) {
  Eigen::Matrix3d ray_from_side;
  ray_from_side << camera_from_world.rotation * side.along, camera_from_world.rotation * side.down,
      camera_from_world * side.middle_m;
  return ray_from_side.inverse().cast<float>();
}

}  // namespace

RoomRenderer::RoomRenderer(const Scenario& scenario, std::size_t index)
    : room_(furnishedRoom(scenario)),
      width_px_(scenario.cameras[index].intrinsics.resolution_px.width_px),
      blur_px_(static_cast<float>(scenario.cameras[index].pixel.effectiveBlur_px())),
      texels_per_m_(static_cast<float>(1.0 / scenario.room.texel_m)),
      focal_px_(static_cast<float>(idealFocalLength_px(scenario.cameras[index].intrinsics).mean())),
      sharpest_texels_(kSharpest_texels) {
  const CameraIntrinsics& camera = scenario.cameras[index].intrinsics;
  const UndistortionTable ideal(camera);
  const Eigen::Vector2d f = idealFocalLength_px(camera);
  for (int y = 0; y < camera.resolution_px.height_px; ++y) {
    for (int x = 0; x < camera.resolution_px.width_px; ++x) {
      const Eigen::Vector2d pixel = ideal(x, y).cast<double>();
      rays_.push_back((pixel - camera.principal_point_px).cwiseQuotient(f).cast<float>());
      const Eigen::Matrix2d per_px = f.cwiseInverse().asDiagonal() * idealPixelScale(camera, pixel);
      ray_per_px_.push_back(per_px.cast<float>());
    }
  }
  pictures_.emplace_back(ClutterTextureOptions{scenario.seed, scenario.scene.clutter_contrast,
                                               scenario.scene.clutter_object_share,
                                               scenario.scene.clutter_round_share, 0.0, sharpest_texels_});
  double blur_texels = sharpest_texels_;
  for (int k = 1; k < kBlurs; ++k, blur_texels *= 2.0)
    pictures_.emplace_back(pictures_.back(), std::sqrt(3.0) * blur_texels);  // (2 s)^2 - s^2
}

RoomRenderer::Instant RoomRenderer::at(const RigidTransform& world_from_camera) const {
  Instant instant;
  instant.world_from_camera = world_from_camera;
  instant.camera_from_world = inverse(world_from_camera);
  const auto place = [&](const RoomSide& side) {
    const bool faces = side.normal().dot(world_from_camera.translation_m - side.middle_m) > 0.0;
    return PlacedSide{sideFromRay(side, instant.camera_from_world), faces};
  };
  std::transform(room_.walls.begin(), room_.walls.end(), instant.walls.begin(), place);
  for (const RoomBox& box : room_.boxes) {
    std::array<PlacedSide, 6>& sides = instant.boxes.emplace_back();
    std::transform(box.sides.begin(), box.sides.end(), sides.begin(), place);
    instant.box_middles_m.push_back(instant.camera_from_world * box.middle_m);
  }
  return instant;
}

RoomRenderer::Cone RoomRenderer::coneOf(const Tile& tile) const {
  Cone cone;
  std::array<Eigen::Vector3d, 4> corners;
  std::size_t k = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int y : {tile.y_px, tile.y_px + tile.height_px - 1})
    for (const int x : {tile.x_px, tile.x_px + tile.width_px - 1}) {
      const Eigen::Vector2f& ray = rays_[static_cast<std::size_t>(y * width_px_ + x)];
      corners[k] = ray.homogeneous().cast<double>().normalized();
      sum += corners[k++];
    }
  cone.axis = sum.normalized();
  for (const Eigen::Vector3d& corner : corners)
    cone.half_angle_rad =
        std::max(cone.half_angle_rad, std::acos(std::clamp(cone.axis.dot(corner), -1.0, 1.0)));
  return cone;
}

// The wall that the ray meets first: the one with the largest 1/z of all walls in front of the camera.
int RoomRenderer::nearestWall(const Instant& instant, const Eigen::Vector2f& ray,
                              float* inverse_depth) const {
  int nearest = 0;
  float largest = 0.0f;
  for (int k = 0; k < 6; ++k) {
    const Eigen::Matrix3f& h = instant.walls[static_cast<std::size_t>(k)].side_from_ray;
    const float w = h(2, 0) * ray.x() + h(2, 1) * ray.y() + h(2, 2);
    if (!(w > largest)) continue;
    largest = w;
    nearest = k;
  }
  if (inverse_depth) *inverse_depth = largest;
  return nearest;
}

// Image motion at this depth, away from the pixel.
float RoomRenderer::travel(std::size_t pixel, float inverse_depth_1_m, const Instants& instants) const {
  const Eigen::Vector2f& ray = rays_[pixel];
  if (!(inverse_depth_1_m > 0.0f)) return 0.0f;
  const Eigen::Vector3d in_world = instants[0]->world_from_camera * (ray.homogeneous().cast<double>() /
                                                                     static_cast<double>(inverse_depth_1_m));
  const Eigen::Matrix2f px_per_ray = ray_per_px_[pixel].inverse();
  Eigen::Vector2f before = ray;
  float path = 0.0f;
  for (const Instant* instant : {instants[1], instants[2]}) {
    const Eigen::Vector3d in_camera = instant->camera_from_world * in_world;
    if (!(in_camera.z() > 0.0)) continue;
    const Eigen::Vector2f after = in_camera.hnormalized().cast<float>();
    const float length = (px_per_ray * (after - before)).norm();
    if (std::isfinite(length)) path += length;
    before = after;
  }
  return path;
}

// Boxes whose bounding spheres may be visible in the tile, the nearest first.
void RoomRenderer::findBoxes(const Tile& tile, const Instants& instants, TileView& view) const {
  view.boxes.clear();
  const Cone cone = coneOf(tile);
  constexpr double kSlack_rad = 0.02;  // motion between the three instants, and blur
  const auto distance = [&](int k) { return instants[1]->box_middles_m[static_cast<std::size_t>(k)].norm(); };
  for (std::size_t k = 0; k < room_.boxes.size(); ++k) {
    const auto seenAt = [&](const Instant* instant) {
      const Eigen::Vector3d& middle = instant->box_middles_m[k];
      const double away_m = middle.norm(),
                   turn_rad = std::acos(std::clamp(cone.axis.dot(middle) / away_m, -1.0, 1.0)),
                   radius_rad = std::asin(std::min(room_.boxes[k].radius_m / away_m, 1.0));
      return turn_rad < radius_rad + cone.half_angle_rad + kSlack_rad;
    };
    if (std::any_of(instants.begin(), instants.end(), seenAt)) view.boxes.push_back(static_cast<int>(k));
  }
  std::sort(view.boxes.begin(), view.boxes.end(), [&](int a, int b) { return distance(a) < distance(b); });
}

// Position of a tile's corner relative to a side: which edges it is beyond, and whether it is well inside all
// of them. Corners suffice, since a side's outline is straight, and so, nearly, is the tile's.
struct RoomRenderer::CornerPlace {
  bool before = false;  // the side's plane is in front of the camera there
  bool within = false;
  std::array<bool, 4> beyond = {};  // +x, +y, -x, -y
};

RoomRenderer::CornerPlace RoomRenderer::cornerOn(const RoomSide& side, const PlacedSide& placed,
                                                 std::size_t pixel) const {
  constexpr float kSlack_px = 1.5f;  // lens distortion, and motion between the instants
  const float clear_px = kStepReach * blur_px_ + kSlack_px;
  const Eigen::Array2f half_m = side.half_m.cast<float>().array();
  const Eigen::Matrix3f& h = placed.side_from_ray;
  const Eigen::Vector3f at = h * rays_[pixel].homogeneous();
  CornerPlace corner;
  if (!(at.z() > 1e-3f)) return corner;
  corner.before = true;
  const Eigen::Vector2f place_m = at.hnormalized();
  const Eigen::Matrix2f per_px =
      (h.topLeftCorner<2, 2>() - place_m * h.block<1, 2>(2, 0)) / at.z() * ray_per_px_[pixel];
  const Eigen::Array2f clear_m = clear_px * per_px.rowwise().norm().array();
  corner.within = (place_m.array().abs() < half_m - clear_m).all();
  for (int k = 0; k < 2; ++k) {
    corner.beyond[static_cast<std::size_t>(k)] = place_m[k] > half_m[k] + clear_m[k];
    corner.beyond[static_cast<std::size_t>(2 + k)] = place_m[k] < -half_m[k] - clear_m[k];
  }
  return corner;
}

RoomRenderer::Extent RoomRenderer::extentOf(std::size_t box, std::size_t side, const Tile& tile,
                                            const Instants& instants) const {
  bool all = true, faces = false, behind = true;
  std::array<bool, 4> beyond = {true, true, true, true};  // by edge: true if all corners are beyond it
  for (const Instant* instant : instants) {
    const PlacedSide& placed = instant->boxes[box][side];
    faces = faces || placed.faces;
    all = all && placed.faces;
    for (const int y : {tile.y_px, tile.y_px + tile.height_px - 1})
      for (const int x : {tile.x_px, tile.x_px + tile.width_px - 1}) {
        const CornerPlace corner =
            cornerOn(room_.boxes[box].sides[side], placed, static_cast<std::size_t>(y * width_px_ + x));
        behind = behind && !corner.before;
        all = all && corner.within;
        for (std::size_t k = 0; k < 4; ++k) beyond[k] = beyond[k] && corner.beyond[k];
      }
  }
  if (all) return Extent::All;
  const bool missed = behind || std::find(beyond.begin(), beyond.end(), true) != beyond.end();
  return faces && !missed ? Extent::Part : Extent::Nothing;
}

// Removes boxes that do not cover the tile, and those behind a side that fills it.
void RoomRenderer::dropHidden(const Tile& tile, const Instants& instants, TileView& view) const {
  view.only_side = -1;
  std::size_t kept = 0;
  for (const int box : view.boxes) {
    bool seen = false;
    int filling = -1;
    for (std::size_t side = 0; side < 6; ++side) {
      const Extent extent = extentOf(static_cast<std::size_t>(box), side, tile, instants);
      seen = seen || extent != Extent::Nothing;
      if (extent == Extent::All) filling = static_cast<int>(side);
    }
    if (!seen) continue;
    view.boxes[kept++] = box;
    if (filling < 0) continue;
    if (kept == 1) view.only_side = filling;
    break;
  }
  view.boxes.resize(kept);
}

void RoomRenderer::look(const Tile& tile, const Instants& instants, TileView& view) const {
  view.travel_px = 0.0f;
  view.wall = -2;  // not yet determined
  findBoxes(tile, instants, view);
  dropHidden(tile, instants, view);
  float nearest_1_m = 0.0f;
  for (const int box : view.boxes) {
    const auto k = static_cast<std::size_t>(box);
    for (const Instant* instant : instants) {
      const double away_m = instant->box_middles_m[k].norm() - room_.boxes[k].radius_m;
      nearest_1_m = std::max(nearest_1_m, static_cast<float>(1.0 / std::max(away_m, 0.05)));
    }
  }
  for (const int y : {tile.y_px, tile.y_px + tile.height_px - 1})
    for (const int x : {tile.x_px, tile.x_px + tile.width_px - 1}) {
      const auto pixel = static_cast<std::size_t>(y * width_px_ + x);
      float wall_1_m = 0.0f;
      for (const Instant* instant : instants) {
        const int wall = nearestWall(*instant, rays_[pixel], &wall_1_m);
        view.wall = view.wall == -2 || view.wall == wall ? wall : -1;
      }
      view.travel_px = std::max(view.travel_px, travel(pixel, wall_1_m, instants));
      if (!view.boxes.empty())
        view.travel_px = std::max(view.travel_px, travel(pixel, nearest_1_m, instants));
    }
}

// Number of texels of the side per pixel at the tile's middle, across its slant.
RoomRenderer::Sharpness RoomRenderer::sharpnessOn(const PlacedSide& side, const Tile& tile) const {
  const auto pixel =
      static_cast<std::size_t>((tile.y_px + tile.height_px / 2) * width_px_ + tile.x_px + tile.width_px / 2);
  const Eigen::Vector3f ray = rays_[pixel].homogeneous();
  const Eigen::Matrix3f& h = side.side_from_ray;
  const Eigen::Vector3f place = h * ray;
  if (!(place.z() > 0.0f)) return {kBlurs - 2, 1.0f};
  const Eigen::Matrix2f per_px =
      (h.topLeftCorner<2, 2>() - place.hnormalized() * h.block<1, 2>(2, 0)) / place.z() * ray_per_px_[pixel];
  const float texels = per_px.norm() * std::sqrt(0.5f) * texels_per_m_ * blur_px_;
  const float level = std::log2(std::max(texels, 1e-3f) / static_cast<float>(sharpest_texels_));
  if (!(level > 0.0f)) return {0, 0.0f};
  const auto below = std::min(static_cast<std::size_t>(level), static_cast<std::size_t>(kBlurs - 2));
  return {below, std::min(level - static_cast<float>(below), 1.0f)};
}

float RoomRenderer::picture(const RoomSide& side, const Eigen::Vector2f& place_m,
                            const Sharpness& sharpness) const {
  const Eigen::Vector2f texel = texels_per_m_ * (place_m + side.picture_m.cast<float>());
  const float sharp = pictures_[sharpness.level](texel.x(), texel.y());
  const float soft = pictures_[sharpness.level + 1](texel.x(), texel.y());
  return static_cast<float>(side.log_tone) + sharp + sharpness.part * (soft - sharp);
}

float RoomRenderer::onWall(const Instant& instant, int wall, const Eigen::Vector2f& ray,
                           const Sharpness& sharpness) const {
  const auto k = static_cast<std::size_t>(wall);
  const Eigen::Vector3f place = instant.walls[k].side_from_ray * ray.homogeneous();
  return picture(room_.walls[k], place.hnormalized(), sharpness);
}

// At an edge between two walls both have the same distance; the pixel's distance from the edge follows from
// the difference of their 1/z.
float RoomRenderer::onWalls(const Instant& instant, std::size_t pixel,
                            const std::array<Sharpness, 6>& sharpness) const {
  const Eigen::Vector2f& ray = rays_[pixel];
  std::array<float, 6> w{};
  int first = 0, second = 1;
  for (int k = 0; k < 6; ++k) {
    const Eigen::Matrix3f& h = instant.walls[static_cast<std::size_t>(k)].side_from_ray;
    w[static_cast<std::size_t>(k)] = h(2, 0) * ray.x() + h(2, 1) * ray.y() + h(2, 2);
  }
  const auto of = [&](int k) { return w[static_cast<std::size_t>(k)]; };
  if (of(second) > of(first)) std::swap(first, second);
  for (int k = 2; k < 6; ++k) {
    if (of(k) > of(first)) {
      second = first;
      first = k;
    } else if (of(k) > of(second)) {
      second = k;
    }
  }
  const auto slope = [&](int k) {
    return instant.walls[static_cast<std::size_t>(k)].side_from_ray.block<1, 2>(2, 0).transpose();
  };
  const Eigen::Vector2f per_px = ray_per_px_[pixel].transpose() * (slope(first) - slope(second));
  const float own = blurredStep((of(first) - of(second)) / (per_px.norm() * blur_px_));
  const float light = onWall(instant, first, ray, sharpness[static_cast<std::size_t>(first)]);
  if (own >= 1.0f || !(of(second) > 0.0f)) return light;
  const float other = onWall(instant, second, ray, sharpness[static_cast<std::size_t>(second)]);
  return std::log(own * std::exp(light) + (1.0f - own) * std::exp(other));
}

// Share of a pixel on a box's side, and its place.
float RoomRenderer::coverOf(const RoomSide& side, const PlacedSide& placed, std::size_t pixel,
                            Eigen::Vector2f& place_m) const {
  const Eigen::Matrix3f& h = placed.side_from_ray;
  const Eigen::Vector3f at = h * rays_[pixel].homogeneous();
  if (!(at.z() > 0.0f)) return 0.0f;
  place_m = at.hnormalized();
  const Eigen::Vector2f inside_m = side.half_m.cast<float>() - place_m.cwiseAbs();
  constexpr float kFar_m = 0.2f;  // larger than any blur
  if (inside_m.minCoeff() < -kFar_m) return 0.0f;
  const Eigen::Matrix2f per_px =
      (h.topLeftCorner<2, 2>() - place_m * h.block<1, 2>(2, 0)) / at.z() * ray_per_px_[pixel];
  const float inside_px = std::min(inside_m.x() / per_px.row(0).norm(), inside_m.y() / per_px.row(1).norm());
  return std::isfinite(inside_px) ? blurredStep(inside_px / blur_px_) : 0.0f;
}

// Sides of a box share edges: there, their shares add up to 1.
float RoomRenderer::lightOfBox(const Instant& instant, int box, std::size_t pixel,
                               const std::array<Sharpness, 6>& sharpness, float& covered) const {
  const auto b = static_cast<std::size_t>(box);
  float light = 0.0f;
  covered = 0.0f;
  for (std::size_t k = 0; k < 6; ++k) {
    const PlacedSide& placed = instant.boxes[b][k];
    if (!placed.faces) continue;
    Eigen::Vector2f place_m;
    const float part = coverOf(room_.boxes[b].sides[k], placed, pixel, place_m);
    if (part <= 0.0f) continue;
    light += part * std::exp(picture(room_.boxes[b].sides[k], place_m, sharpness[k]));
    covered += part;
  }
  if (covered <= 0.0f) return 0.0f;
  light /= covered;
  covered = std::min(covered, 1.0f);
  return light;
}

void RoomRenderer::renderSide(const RoomSide& side, const PlacedSide& placed, const Tile& tile,
                              float* log_intensity) const {
  const Sharpness sharpness = sharpnessOn(placed, tile);
  const Eigen::Matrix3f& h = placed.side_from_ray;
  const ClutterTexture& sharp = pictures_[sharpness.level];
  const ClutterTexture& soft = pictures_[sharpness.level + 1];
  const Eigen::Vector2f origin = texels_per_m_ * side.picture_m.cast<float>();
  const auto tone = static_cast<float>(side.log_tone);
  for (int y = tile.y_px; y < tile.y_px + tile.height_px; ++y) {
    const Eigen::Vector2f* ray = &rays_[static_cast<std::size_t>(y * width_px_ + tile.x_px)];
    for (int x = 0; x < tile.width_px; ++x, ++ray) {
      const float scale = texels_per_m_ / (h(2, 0) * ray->x() + h(2, 1) * ray->y() + h(2, 2));
      const float u = scale * (h(0, 0) * ray->x() + h(0, 1) * ray->y() + h(0, 2)) + origin.x(),
                  v = scale * (h(1, 0) * ray->x() + h(1, 1) * ray->y() + h(1, 2)) + origin.y();
      const float light = sharp(u, v);
      *log_intensity++ = tone + light + sharpness.part * (soft(u, v) - light);
    }
  }
}

void RoomRenderer::render(const Instant& instant, const Tile& tile, const TileView& view,
                          float* log_intensity) const {
  if (view.only_side >= 0) {
    const auto box = static_cast<std::size_t>(view.boxes.front()),
               side = static_cast<std::size_t>(view.only_side);
    return renderSide(room_.boxes[box].sides[side], instant.boxes[box][side], tile, log_intensity);
  }
  if (view.boxes.empty() && view.wall >= 0) {
    const auto wall = static_cast<std::size_t>(view.wall);
    return renderSide(room_.walls[wall], instant.walls[wall], tile, log_intensity);
  }
  std::array<Sharpness, 6> sharpness;
  for (std::size_t k = 0; k < 6; ++k)
    if (view.wall < 0 || static_cast<std::size_t>(view.wall) == k)
      sharpness[k] = sharpnessOn(instant.walls[k], tile);
  std::vector<std::array<Sharpness, 6>> of_boxes(view.boxes.size());
  for (std::size_t b = 0; b < of_boxes.size(); ++b) {
    const auto& sides = instant.boxes[static_cast<std::size_t>(view.boxes[b])];
    for (std::size_t k = 0; k < 6; ++k)
      if (sides[k].faces) of_boxes[b][k] = sharpnessOn(sides[k], tile);
  }
  for (int y = tile.y_px; y < tile.y_px + tile.height_px; ++y) {
    auto pixel = static_cast<std::size_t>(y * width_px_ + tile.x_px);
    for (int x = 0; x < tile.width_px; ++x, ++pixel) {
      float light = 0.0f, left = 1.0f;
      for (std::size_t b = 0; b < of_boxes.size(); ++b) {
        float covered = 0.0f;
        const float own = lightOfBox(instant, view.boxes[b], pixel, of_boxes[b], covered);
        light += left * covered * own;
        left *= 1.0f - covered;
        if (left < 1e-3f) break;
      }
      if (left < 1e-3f) {
        *log_intensity++ = std::log(light);
        continue;
      }
      const float wall = view.wall >= 0 ? onWall(instant, view.wall, rays_[pixel],
                                                 sharpness[static_cast<std::size_t>(view.wall)])
                                        : onWalls(instant, pixel, sharpness);
      *log_intensity++ = left >= 1.0f ? wall : std::log(light + left * std::exp(wall));
    }
  }
}

}  // namespace evical
