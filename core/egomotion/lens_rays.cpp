#include "core/egomotion/lens_rays.h"

#include "core/geometry/camera_model.h"

#include <Eigen/LU>

#include <cmath>
#include <optional>

namespace evical {

LensRays::LensRays(const CameraIntrinsics& camera)
    : resolution_px_(camera.resolution_px), focal_length_px_(idealFocalLength_px(camera).mean()) {
  const Eigen::Vector2d f = idealFocalLength_px(camera);
  rays_.resize(static_cast<std::size_t>(resolution_px_.pixelCount()));
  auto ray = rays_.begin();
  for (int y = 0; y < resolution_px_.height_px; ++y)
    for (int x = 0; x < resolution_px_.width_px; ++x, ++ray) {
      const std::optional<Eigen::Vector2d> ideal = idealPixel(camera, Eigen::Vector2d(x, y));
      if (!ideal) continue;
      const Eigen::Matrix2d per_px = f.cwiseInverse().asDiagonal() * idealPixelScale(camera, *ideal);
      const Eigen::Matrix2d px_per_place = per_px.inverse();
      if (!px_per_place.allFinite()) continue;
      ray->place = (*ideal - camera.principal_point_px).cwiseQuotient(f).cast<float>();
      ray->px_per_place = px_per_place.cast<float>();
      ray->known = true;
    }
}

}  // namespace evical
