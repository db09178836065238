// Log intensity of the board and the clutter behind it, as the blurred image has it.
#pragma once

#include "core/geometry/rigid_transform.h"
#include "core/synthetic/scenario.h"

#include <Eigen/Core>

#include <vector>

namespace evical {

class SceneRenderer {
 public:
  SceneRenderer(const Scenario& scenario, std::size_t camera);

  // The planes' homographies for one instant: from undistorted rays (x/z, y/z) to metres on the planes.
  struct Instant {
    Eigen::Matrix3f board_from_ray, background_from_ray;
    Eigen::Vector3f eye_in_board_m;
  };
  Instant at(const RigidTransform& world_from_camera) const;

  // Log intensity of a pixel.
  float logIntensity(const Instant& instant, int x_px, int y_px) const;

 private:
  float background(float x_m, float y_m) const;
  float edge(float distance_px) const;  // blurred step, 0..1

  const Scenario& scenario_;
  int width_px_;
  float blur_px_, log_bright_;
  std::vector<Eigen::Vector2f> rays_;        // per pixel
  std::vector<Eigen::Matrix2f> ray_per_px_;  // d(ray)/d(pixel)
  std::vector<float> texture_;               // log reflectance, periodic
  float texels_per_m_;
  std::vector<float> edge_table_;
};

}  // namespace evical
