// Log intensity of the board and the clutter behind it, as the blurred image has it. The image is rendered in
// tiles: for some milliseconds most of them show one thing only, or nothing that changes.
#pragma once

#include "core/geometry/rigid_transform.h"
#include "core/synthetic/clutter_texture.h"
#include "core/synthetic/scenario.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace evical {

class SceneRenderer {
 public:
  static constexpr int kTile_px = 8;

  SceneRenderer(const Scenario& scenario, std::size_t camera);

  // The planes' homographies for one instant: from undistorted rays (x/z, y/z) to metres on the planes.
  struct Instant {
    Eigen::Matrix3f board_from_ray, background_from_ray;
  };
  Instant at(const RigidTransform& world_from_camera) const;

  struct Tile {
    int x_px = 0, y_px = 0, width_px = 0, height_px = 0;
    int pixelCount() const { return width_px * height_px; }
  };
  int tileColumns() const { return (width_px_ + kTile_px - 1) / kTile_px; }
  int tileRows() const { return (height_px_ + kTile_px - 1) / kTile_px; }
  Tile tile(int column, int row) const;

  // What a tile shows from the first to the last of three instants.
  enum class Content { Paper, Circles, Clutter, Mixed };
  struct TileView {
    Content content = Content::Mixed;
    bool constant = false;   // one shade all over
    float travel_px = 0.0f;  // how far the image moves there, at most
    float reach_m = 0.0f;    // further than this from an edge on the board nothing of it is seen
    std::vector<Eigen::Vector2f> circles_m;  // centres of those that it may show
  };
  using Instants = std::array<const Instant*, 3>;  // begin, middle, end
  void look(const Tile& tile, const Instants& instants, TileView& view) const;

  // Row by row.
  void render(const Instant& instant, const Tile& tile, const TileView& view, float* log_intensity) const;

 private:
  float edge(float distance_px) const;  // blurred step, 0..1
  float clutter(const Instant& instant, const Eigen::Vector2f& ray) const;
  float onBoard(const Instant& instant, std::size_t pixel, const TileView& view) const;
  float sheet(const Eigen::Vector2f& point_m, const Eigen::Matrix2f& board_per_px) const;
  float disk(const Eigen::Vector2f& away_m, const Eigen::Matrix2f& board_per_px) const;
  float travel(std::size_t pixel, const Instants& instants) const;
  void findCircles(const Eigen::Vector2f& low_m, const Eigen::Vector2f& high_m, TileView& view) const;

  CircleBoard board_;
  double row_spacing_m_;  // of the real board
  SceneModel scene_;
  int width_px_, height_px_;
  float blur_px_, paper_, ink_, log_paper_, log_ink_;
  Eigen::Vector2f board_low_m_, board_high_m_;  // the sheet's corners
  std::vector<Eigen::Vector2f> rays_;           // per pixel; NaN where there is none
  std::vector<Eigen::Matrix2f> ray_per_px_;     // d(ray)/d(pixel)
  float texels_per_m_;
  ClutterTexture texture_;
  std::vector<float> edge_table_;
};

}  // namespace evical
