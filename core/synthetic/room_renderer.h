// Log intensity of a furnished room in the blurred image: SceneRenderer's tiles with another scene. Each ray
// sees the picture on the nearest side; at edges, sides are weighted by their share of the pixel.
#pragma once

#include "core/geometry/so3.h"
#include "core/synthetic/clutter_texture.h"
#include "core/synthetic/room_scene.h"
#include "core/synthetic/scene_renderer.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace evical {

class RoomRenderer {
 public:
  RoomRenderer(const Scenario& scenario, std::size_t camera);

  // From rays (x/z, y/z) to metres on a side; the third coordinate is 1/z.
  struct PlacedSide {
    Eigen::Matrix3f side_from_ray;
    bool faces = false;  // its front is visible
  };
  struct Instant {
    RigidTransform camera_from_world, world_from_camera;
    std::array<PlacedSide, 6> walls;
    std::vector<std::array<PlacedSide, 6>> boxes;
    std::vector<Eigen::Vector3d> box_middles_m;  // in the camera frame
  };
  Instant at(const RigidTransform& world_from_camera) const;

  using Tile = SceneRenderer::Tile;
  using Instants = std::array<const Instant*, 3>;
  struct TileView {
    int wall = -1;           // the only one there; -1: several
    std::vector<int> boxes;  // possibly visible boxes, the nearest first
    int only_side = -1;      // of the first box, if it hides everything else
    float travel_px = 0.0f;  // largest image motion there
  };
  void look(const Tile& tile, const Instants& instants, TileView& view) const;
  // Row by row.
  void render(const Instant& instant, const Tile& tile, const TileView& view, float* log_intensity) const;

 private:
  struct Cone {
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
    double half_angle_rad = 0.0;
  };
  // A tile's picture on one side: interpolated between two blurs.
  struct Sharpness {
    std::size_t level = 0;
    float part = 0.0f;
  };

  // Part of a tile on a box's side, from the first to the last instant.
  enum class Extent { Nothing, Part, All };
  struct CornerPlace;

  Cone coneOf(const Tile& tile) const;
  CornerPlace cornerOn(const RoomSide& side, const PlacedSide& placed, std::size_t pixel) const;
  Extent extentOf(std::size_t box, std::size_t side, const Tile& tile, const Instants& instants) const;
  void findBoxes(const Tile& tile, const Instants& instants, TileView& view) const;
  void dropHidden(const Tile& tile, const Instants& instants, TileView& view) const;
  int nearestWall(const Instant& instant, const Eigen::Vector2f& ray, float* inverse_depth) const;
  float travel(std::size_t pixel, float inverse_depth_1_m, const Instants& instants) const;
  Sharpness sharpnessOn(const PlacedSide& side, const Tile& tile) const;
  float picture(const RoomSide& side, const Eigen::Vector2f& place_m, const Sharpness& sharpness) const;
  void renderSide(const RoomSide& side, const PlacedSide& placed, const Tile& tile,
                  float* log_intensity) const;
  float onWall(const Instant& instant, int wall, const Eigen::Vector2f& ray,
               const Sharpness& sharpness) const;
  float onWalls(const Instant& instant, std::size_t pixel, const std::array<Sharpness, 6>& sharpness) const;
  float coverOf(const RoomSide& side, const PlacedSide& placed, std::size_t pixel,
                Eigen::Vector2f& place_m) const;
  float lightOfBox(const Instant& instant, int box, std::size_t pixel,
                   const std::array<Sharpness, 6>& sharpness, float& covered) const;

  RoomScene room_;
  int width_px_;
  float blur_px_, texels_per_m_, focal_px_;
  std::vector<Eigen::Vector2f> rays_;        // per pixel; NaN without one
  std::vector<Eigen::Matrix2f> ray_per_px_;  // d(ray)/d(pixel)
  std::vector<ClutterTexture> pictures_;     // each with twice the blur of the previous one
  double sharpest_texels_;
};

}  // namespace evical
