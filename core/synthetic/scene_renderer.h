// Log intensity of the board and the clutter behind it in the blurred image. The image is rendered in
// tiles: for some milliseconds most of them show only one object, or nothing that changes.
#pragma once

#include "core/geometry/so3.h"
#include "core/synthetic/board_surface.h"
#include "core/synthetic/clutter_texture.h"
#include "core/synthetic/scenario.h"
#include "core/synthetic/visitors.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace evical {

class SceneRenderer {
 public:
  static constexpr int kTile_px = 8;

  SceneRenderer(const Scenario& scenario, std::size_t camera);

  // The planes' homographies for one instant: from undistorted rays (x/z, y/z) to metres on the planes; and
  // the visible figures, the hand last.
  struct PlacedFigure {
    Figure figure;
    Eigen::Matrix3f plane_from_ray;
  };
  struct Instant {
    Eigen::Matrix3f board_from_ray, background_from_ray;
    Eigen::Vector3f camera_m = Eigen::Vector3f::Zero();
    std::vector<PlacedFigure> figures = {};
  };
  Instant at(const RigidTransform& world_from_camera, double time_s) const;

  struct Tile {
    int x_px = 0, y_px = 0, width_px = 0, height_px = 0;
    int pixelCount() const { return width_px * height_px; }
  };
  int tileColumns() const { return (width_px_ + kTile_px - 1) / kTile_px; }
  int tileRows() const { return (height_px_ + kTile_px - 1) / kTile_px; }
  Tile tile(int column, int row) const;

  // Ink of a board of squares.
  struct InkBox {
    Eigen::Vector2f low_m, high_m;
  };

  // Content of a tile from the first to the last of three instants.
  enum class Content { Paper, Pattern, Clutter, Mixed };
  struct TileView {
    Content content = Content::Mixed;
    bool constant = false;                   // uniform shade
    float travel_px = 0.0f;                  // largest image motion there
    float reach_m = 0.0f;                    // largest distance at which an edge on the board has an effect
    std::vector<Eigen::Vector2f> circles_m;  // centres of possibly visible circles
    std::vector<InkBox> boxes;               // of ink, possibly visible
    // Passing objects: figures in a set of bits, the hand's shadow, the lamp in the varnish.
    unsigned figures = 0;
    bool shadow = false, gloss = false;
    bool isVisited() const { return figures != 0 || shadow || gloss; }
  };
  using Instants = std::array<const Instant*, 3>;  // begin, middle, end
  void look(const Tile& tile, const Instants& instants, TileView& view) const;
  // Motion of the figures' images there, visible or not.
  float visitorsTravel_px(const Tile& tile, const Instants& instants) const;

  // Row by row.
  void render(const Instant& instant, const Tile& tile, const TileView& view, float* log_intensity) const;

 private:
  static constexpr float kEdgeReach = 4.0f;  // in sigmas of the blur

  // Share of a pixel on the sheet, its place, and the share of ink in it.
  struct BoardPart {
    float on_board = 0.0f, ink = 0.0f;
    Eigen::Vector2f point_m = Eigen::Vector2f::Zero();
  };
  // A pixel's view of a figure.
  struct Seen {
    Eigen::Vector2f own_m = Eigen::Vector2f::Zero();
    float metres_per_px = 0.0f;
  };

  void layBoxes(const Scenario& scenario);
  static Eigen::Matrix3f planeFromRay(const RigidTransform& camera_from_world, double depth_m);
  static Eigen::Matrix2f planeDerivative(const Eigen::Matrix3f& plane_from_ray, const Eigen::Vector2f& point,
                                         float depth);
  void lookAtPlanes(const Tile& tile, const Instants& instants, TileView& view) const;
  void bend(const Instant& instant, Eigen::Vector2f& point_m, Eigen::Matrix2f& board_per_px) const;
  template <bool kBent>
  BoardPart partOf(const Instant& instant, std::size_t pixel, const TileView& view) const;
  BoardPart boardPart(const Instant& instant, std::size_t pixel, const TileView& view) const;
  float edge(float distance_px) const;  // blurred step, 0..1
  float clutter(const Instant& instant, const Eigen::Vector2f& ray) const;
  template <bool kBent>
  float onBoard(const Instant& instant, std::size_t pixel, const TileView& view) const;
  float sheet(const Eigen::Vector2f& point_m, const Eigen::Matrix2f& board_per_px) const;
  float disk(const Eigen::Vector2f& away_m, const Eigen::Matrix2f& board_per_px) const;
  float travel(std::size_t pixel, const Instants& instants) const;
  float inkOf(const Eigen::Vector2f& point_m, const Eigen::Matrix2f& board_per_px,
              const TileView& view) const;
  void findBoxes(const Eigen::Vector2f& low_m, const Eigen::Vector2f& high_m, TileView& view) const;
  void findCircles(const Eigen::Vector2f& low_m, const Eigen::Vector2f& high_m, TileView& view) const;

  // visited_scene.cpp
  std::vector<PlacedFigure> figuresAt(const RigidTransform& camera_from_world, double time_s) const;
  bool see(const PlacedFigure& placed, std::size_t pixel, Seen& seen) const;
  float travelOf(const PlacedFigure& placed, const Instants& instants, std::size_t pixel) const;
  void lookForVisits(const Tile& tile, const Instants& instants, TileView& view) const;
  Eigen::Vector3f pointOnBoard(const Instant& instant, std::size_t pixel) const;
  Eigen::Vector3f onSheet(const Eigen::Vector2f& point_m) const;
  Eigen::Vector2f castOnto(const Eigen::Vector2f& point_m) const;
  Eigen::Vector3f offTheLamp(const Instant& instant, const Eigen::Vector3f& point_m) const;
  float litSheet(const Instant& instant, const BoardPart& board, const TileView& view) const;
  void cover(const PlacedFigure& placed, std::size_t pixel, float& light) const;
  float visited(const Instant& instant, std::size_t pixel, const TileView& view) const;
  void renderVisited(const Instant& instant, const Tile& tile, const TileView& view,
                     float* log_intensity) const;

  Scenario scenario_;
  Board board_;
  BoardSurface surface_;
  double row_spacing_m_;       // of the real board
  std::vector<InkBox> boxes_;  // of a board without circles
  SceneModel scene_;
  bool is_visited_;  // at times: by figures, or by a lamp's reflection in the varnish
  Eigen::Vector3f lamp_m_;
  float shadow_sigma_m_;  // of its visible edge
  int width_px_, height_px_;
  float blur_px_, paper_, ink_, log_paper_, log_ink_;
  Eigen::Vector2f board_low_m_, board_high_m_;  // the sheet's corners
  std::vector<Eigen::Vector2f> rays_;           // per pixel; NaN without one
  std::vector<Eigen::Matrix2f> ray_per_px_;     // d(ray)/d(pixel)
  float texels_per_m_;
  ClutterTexture texture_;
  std::vector<float> edge_table_;
};

}  // namespace evical
