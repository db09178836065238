// Ray of every pixel, and its derivative, for motion estimation.
#pragma once

#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace evical {

class LensRays {
 public:
  explicit LensRays(const CameraIntrinsics& camera);

  struct Ray {
    Eigen::Vector2f place = Eigen::Vector2f::Zero();         // (x/z, y/z)
    Eigen::Matrix2f px_per_place = Eigen::Matrix2f::Zero();  // d(pixel) / d(place)
    bool known = false;
  };
  const Ray& at(int x_px, int y_px) const {
    return rays_[static_cast<std::size_t>(y_px) * static_cast<std::size_t>(resolution_px_.width_px) +
                 static_cast<std::size_t>(x_px)];
  }
  Resolution resolution_px() const { return resolution_px_; }
  double focalLength_px() const { return focal_length_px_; }

 private:
  Resolution resolution_px_;
  double focal_length_px_;
  std::vector<Ray> rays_;
};

}  // namespace evical
