// The renderer for tiles with a hand or its shadow, people or a glossy spot.
#include "core/synthetic/scene_renderer.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace evical {
namespace {

constexpr float kSlack_m = 0.03f;        // motion of figures between the instants of a tile
constexpr float kGlossReach = 4.5f;      // in sigmas of the spot
constexpr float kMeanOfTexture = -1.2f;  // log reflectance

// Bounding box of the places of a tile's corners.
template <int Size>
struct Box {
  using Vector = Eigen::Matrix<float, Size, 1>;
  Vector low = Vector::Constant(std::numeric_limits<float>::max()), high = -low;

  void add(const Vector& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  bool touches(const Vector& other_low, const Vector& other_high, float margin) const {
    return (low.array() - margin < other_high.array()).all() &&
           (high.array() + margin > other_low.array()).all();
  }
};

unsigned slotOf(const Figure& figure) {
  constexpr unsigned kSlots = 31;  // the first is the hand's; figures that share a slot only cost time
  return figure.isInFront() ? 1u : 2u << (static_cast<unsigned>(figure.visit) % (kSlots - 1));
}

const SceneRenderer::PlacedFigure* sameIn(const SceneRenderer::Instant& instant, const Figure& figure) {
  for (const SceneRenderer::PlacedFigure& other : instant.figures)
    if (other.figure.visit == figure.visit) return &other;
  return nullptr;
}

}  // namespace

std::vector<SceneRenderer::PlacedFigure> SceneRenderer::figuresAt(const RigidTransform& camera_from_world,
                                                                  double time_s) const {
  std::vector<PlacedFigure> placed;
  const auto place = [&](const Figure& figure) {
    placed.push_back({figure, planeFromRay(camera_from_world, figure.behind_board_m)});
  };
  for (const Figure& person : peopleAt(scenario_, time_s)) place(person);
  if (const std::optional<Figure> hand = handAt(scenario_, time_s)) place(*hand);
  return placed;
}

// The pixel's view of the figure's plane, in the figure's coordinates; false if it does not see it.
bool SceneRenderer::see(const PlacedFigure& placed, std::size_t pixel, Seen& seen) const {
  const Eigen::Vector3f b = placed.plane_from_ray * rays_[pixel].homogeneous();
  if (!(b.z() > 0.0f)) return false;
  const Eigen::Vector2f point = b.hnormalized();
  seen.own_m = placed.figure.own_m(point);
  const Eigen::Matrix2f per_px = planeDerivative(placed.plane_from_ray, point, b.z()) * ray_per_px_[pixel];
  seen.metres_per_px = std::sqrt(std::abs(per_px.determinant()));
  return seen.metres_per_px > 0.0f;
}

// Motion of a figure's image away from a pixel.
float SceneRenderer::travelOf(const PlacedFigure& placed, const Instants& instants, std::size_t pixel) const {
  float path = 0.0f;
  for (std::size_t half = 0; half < 2; ++half) {
    const PlacedFigure *from = sameIn(*instants[half], placed.figure),
                       *to = sameIn(*instants[half + 1], placed.figure);
    Seen before, after;
    if (from == nullptr || to == nullptr || !see(*from, pixel, before) || !see(*to, pixel, after)) continue;
    path += (after.own_m - before.own_m).norm() / before.metres_per_px;
  }
  return path;
}

float SceneRenderer::visitorsTravel_px(const Tile& tile, const Instants& instants) const {
  float farthest = 0.0f;
  for (const PlacedFigure& placed : instants[1]->figures)
    farthest = std::max(
        farthest, travelOf(placed, instants, static_cast<std::size_t>(tile.y_px * width_px_ + tile.x_px)));
  return std::isfinite(farthest) ? farthest : 0.0f;
}

void SceneRenderer::lookForVisits(const Tile& tile, const Instants& instants, TileView& view) const {
  view.figures = 0;
  view.shadow = view.gloss = false;
  const std::array<int, 2> xs = {tile.x_px, tile.x_px + tile.width_px - 1},
                           ys = {tile.y_px, tile.y_px + tile.height_px - 1};
  const auto overCorners = [&](auto&& visit) {
    for (const int y : ys)
      for (const int x : xs) visit(static_cast<std::size_t>(y * width_px_ + x));
  };
  float travel_px = 0.0f;
  Box<3> mirrored;
  const bool all_board = view.content == Content::Paper || view.content == Content::Pattern;
  for (const Instant* instant : instants) {
    for (const PlacedFigure& placed : instant->figures) {
      if (all_board && !placed.figure.isInFront()) continue;
      Box<2> direct, shadowed;
      float reach_m = 0.0f;
      overCorners([&](std::size_t pixel) {
        Seen seen;
        if (!see(placed, pixel, seen)) return;
        direct.add(seen.own_m);
        reach_m = std::max(reach_m, kEdgeReach * blur_px_ * seen.metres_per_px);
        shadowed.add(placed.figure.own_m(castOnto(pointOnBoard(*instant, pixel).head<2>())));
      });
      const Figure& figure = placed.figure;
      const bool seen = direct.touches(figure.low_m, figure.high_m, reach_m + kSlack_m);
      const bool shadow =
          figure.isInFront() && view.content != Content::Clutter &&
          shadowed.touches(figure.low_m, figure.high_m, kEdgeReach * shadow_sigma_m_ + kSlack_m);
      if (seen) view.figures |= slotOf(figure);
      view.shadow = view.shadow || shadow;
      if (!seen && !shadow) continue;
      overCorners(
          [&](std::size_t pixel) { travel_px = std::max(travel_px, travelOf(placed, instants, pixel)); });
    }
    if (scene_.gloss.strength > 0.0 && view.content != Content::Clutter)
      overCorners(
          [&](std::size_t pixel) { mirrored.add(offTheLamp(*instant, pointOnBoard(*instant, pixel))); });
  }
  const Eigen::Vector3f nearest = Eigen::Vector3f::Zero().cwiseMax(mirrored.low).cwiseMin(mirrored.high);
  view.gloss = scene_.gloss.strength > 0.0 && view.content != Content::Clutter &&
               nearest.norm() < kGlossReach * static_cast<float>(scene_.gloss.spread_rad);
  if (!view.isVisited()) return;
  view.constant = false;
  // The shadow moves on a moving board.
  if (std::isfinite(travel_px))
    view.travel_px = view.shadow ? view.travel_px + travel_px : std::max(view.travel_px, travel_px);
}

Eigen::Vector3f SceneRenderer::pointOnBoard(const Instant& instant, std::size_t pixel) const {
  const Eigen::Vector2f point = (instant.board_from_ray * rays_[pixel].homogeneous()).hnormalized();
  return onSheet(surface_.isBent() ? surface_.hit(point, instant.camera_m).point_m : point);
}

Eigen::Vector3f SceneRenderer::onSheet(const Eigen::Vector2f& point_m) const {
  return {point_m.x(), point_m.y(),
          surface_.isBent() ? static_cast<float>(surface_.behind_m(point_m.cast<double>())) : 0.0f};
}

// Point in the hand's plane on the light path from the lamp to a point of the board.
Eigen::Vector2f SceneRenderer::castOnto(const Eigen::Vector2f& point_m) const {
  const auto part = static_cast<float>(scene_.hand.height_m) / -lamp_m_.z();
  return point_m + part * (lamp_m_.head<2>() - point_m);
}

// Angle between the reflected viewing direction at a point of the sheet and the direction to the lamp.
Eigen::Vector3f SceneRenderer::offTheLamp(const Instant& instant, const Eigen::Vector3f& point_m) const {
  Eigen::Vector3f normal(0.0f, 0.0f, -1.0f);
  if (surface_.isBent()) normal.head<2>() = surface_.slope(point_m.head<2>().cast<double>()).cast<float>();
  normal.normalize();
  const Eigen::Vector3f view = (point_m - instant.camera_m).normalized();
  return view - 2.0f * view.dot(normal) * normal - (lamp_m_ - point_m).normalized();
}

// The sheet's light: less of the lamp's in the hand's shadow, and the reflection of the lamp.
float SceneRenderer::litSheet(const Instant& instant, const BoardPart& board, const TileView& view) const {
  float light = paper_ + (ink_ - paper_) * board.ink;
  if (view.shadow && !instant.figures.empty() && instant.figures.back().figure.isInFront()) {
    const Figure& hand = instant.figures.back().figure;
    const float inside_m = hand.inside_m(hand.own_m(castOnto(board.point_m)));
    light *= 1.0f - static_cast<float>(scene_.hand.shadow) * edge(inside_m / shadow_sigma_m_ * blur_px_);
  }
  if (!view.gloss) return light;
  const float off =
      offTheLamp(instant, onSheet(board.point_m)).norm() / static_cast<float>(scene_.gloss.spread_rad);
  return light + static_cast<float>(scene_.gloss.strength) * std::exp(-0.5f * off * off);
}

// Draws the figure over its background.
void SceneRenderer::cover(const PlacedFigure& placed, std::size_t pixel, float& light) const {
  Seen seen;
  if (!see(placed, pixel, seen)) return;
  const Figure& figure = placed.figure;
  const float covered = edge(figure.inside_m(seen.own_m) / seen.metres_per_px);
  if (covered <= 0.0f) return;
  const Eigen::Vector2f texel = texels_per_m_ * (seen.own_m + figure.texture_m);
  const float own =
      std::exp(figure.log_tone + figure.contrast * (texture_(texel.x(), texel.y()) - kMeanOfTexture));
  light += covered * (own - light);
}

float SceneRenderer::visited(const Instant& instant, std::size_t pixel, const TileView& view) const {
  const BoardPart board = view.content == Content::Clutter ? BoardPart{} : boardPart(instant, pixel, view);
  const auto coverAll = [&](bool in_front, float& light) {
    for (const PlacedFigure& placed : instant.figures)
      if (placed.figure.isInFront() == in_front && (view.figures & slotOf(placed.figure)) != 0)
        cover(placed, pixel, light);
  };
  float light = 0.0f;
  if (board.on_board < 1.0f) {
    light = std::exp(clutter(instant, rays_[pixel]));
    coverAll(false, light);
    light *= 1.0f - board.on_board;
  }
  if (board.on_board > 0.0f) light += board.on_board * litSheet(instant, board, view);
  coverAll(true, light);
  return std::log(light);
}

void SceneRenderer::renderVisited(const Instant& instant, const Tile& tile, const TileView& view,
                                  float* log_intensity) const {
  for (int y = tile.y_px; y < tile.y_px + tile.height_px; ++y) {
    auto pixel = static_cast<std::size_t>(y * width_px_ + tile.x_px);
    for (int x = 0; x < tile.width_px; ++x) *log_intensity++ = visited(instant, pixel++, view);
  }
}

}  // namespace evical
