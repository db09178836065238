// Cameras that project onto spheres first, and so see beyond 90 degrees off axis: double sphere, EUCM, omni
// (docs/maths.md, 3.1). A pixel is focal length * image + principal point.
#pragma once

#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/pinhole_distortion.h"

#include <Eigen/Core>

#include <optional>

namespace evical {

inline bool isSphereModel(CameraModel model) {
  return model == CameraModel::DoubleSphere || model == CameraModel::Eucm || model == CameraModel::OmniRadtan;
}

// Whose first coefficient, xi, is how far a sphere's centre is from the other one: the scale on the axis is f / (1 + xi).
inline bool hasCentresApart(CameraModel model) {
  return model == CameraModel::DoubleSphere || model == CameraModel::OmniRadtan;
}

struct SphereImage {
  Eigen::Vector2d image;
  Eigen::Matrix<double, 2, 3> by_point;
  DistortionJacobian by_coefficients;
  bool seen;  // else another direction, nearer to the axis, has this image, or there is none
};
SphereImage sphereImage(const CameraIntrinsics& camera, const Eigen::Vector3d& point_in_camera);

// Unit; nothing where no direction has this image.
std::optional<Eigen::Vector3d> sphereRay(const CameraIntrinsics& camera, const Eigen::Vector2d& image);

}  // namespace evical
