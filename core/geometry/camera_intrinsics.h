// Parameters of a camera; camera_model.h has the projection.
#pragma once

#include "core/geometry/resolution.h"

#include <Eigen/Core>

#include <array>

namespace evical {

enum class CameraModel { PinholeRadtan, PinholeEquidistant, DoubleSphere, Eucm, OmniRadtan };

struct CameraIntrinsics {
  CameraModel model = CameraModel::PinholeRadtan;
  Resolution resolution_px;
  Eigen::Vector2d focal_length_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d principal_point_px = Eigen::Vector2d::Zero();
  // Radtan: k1 k2 p1 p2 k3; equidistant: k1 k2 k3 k4; double sphere: xi alpha; EUCM: alpha beta; omni: xi k1
  // k2 p1 p2. Unused coefficients are 0.
  std::array<double, 5> distortion = {0.0, 0.0, 0.0, 0.0, 0.0};

  bool operator==(const CameraIntrinsics&) const = default;
};

}  // namespace evical
