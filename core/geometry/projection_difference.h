// Difference between the projections of two cameras, over the image; to first order, and as a difference. The
// best rotation of one camera relative to the other is removed: the pose absorbs it when intrinsics are used,
// and a principal point would seem much less accurate than projections are.
#pragma once

#include "core/geometry/camera_model.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace evical {

// Pixels at the centres of columns x rows cells, row by row, and the derivatives of their rays' projections
// with respect to the intrinsics.
class ProjectionChange {
 public:
  struct Place {
    Eigen::Vector2d pixel;
    std::optional<IntrinsicsJacobian> by_intrinsics;  // empty if there is no ray
  };

  ProjectionChange(const CameraIntrinsics& camera, int columns, int rows);
  const std::vector<Place>& places() const { return places_; }

 private:
  std::vector<Place> places_;
};

struct ProjectionDifference {
  double rms_px = 0.0, max_px = 0.0;
  int places = 0;  // number of compared places
};

// Differences of `other` from `camera` at the centres of columns x rows cells, row by row, for the same rays.
// Empty if there is no ray, or if `other` does not see it. The image's size is that of `camera`.
std::vector<std::optional<Eigen::Vector2d>> projectionDifferences(const CameraIntrinsics& camera,
                                                                  const CameraIntrinsics& other, int columns,
                                                                  int rows);

// Difference of `other` from `camera` (with the same image size), over the part of the image within
// `radius_share` of the distance from the principal point to the furthest corner.
ProjectionDifference projectionDifference(const CameraIntrinsics& camera, const CameraIntrinsics& other,
                                          double radius_share = 1.0);

}  // namespace evical
