// Cameras that first project onto spheres, and so see more than 90 degrees off axis: double sphere, EUCM,
// omni (docs/maths.md, 3.1). A pixel is focal length * image + principal point.
#pragma once

#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/camera_model.h"

#include <Eigen/Core>

#include <optional>

namespace evical {

inline bool isSphereModel(CameraModel model) {
  return model == CameraModel::DoubleSphere || model == CameraModel::Eucm || model == CameraModel::OmniRadtan;
}

// True if the first coefficient is xi, the distance between the spheres' centres: the scale on the axis is f
// / (1 + xi).
inline bool hasCentresApart(CameraModel model) {
  return model == CameraModel::DoubleSphere || model == CameraModel::OmniRadtan;
}

struct SphereImage {
  Eigen::Vector2d image;
  Eigen::Matrix<double, 2, 3> by_point;
  DistortionJacobian by_coefficients;
  bool seen;  // false: no image, or a direction nearer to the axis has the same one
};
SphereImage sphereImage(const CameraIntrinsics& camera, const Eigen::Vector3d& point_in_camera);

// Unit vector; empty if no direction has this image.
std::optional<Eigen::Vector3d> sphereRay(const CameraIntrinsics& camera, const Eigen::Vector2d& image);

}  // namespace evical
