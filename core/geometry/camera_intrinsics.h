// Parameters of a camera; camera_model.h has the projection.
#pragma once

#include "core/geometry/resolution.h"

#include <Eigen/Core>

#include <array>
#include <initializer_list>

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

// Intrinsics as nine plain numbers, for solvers: in the order of IntrinsicsJacobian (camera_model.h), fx fy
// cx cy d0 d1 d2 d3 d4; pixels, and coefficients without unit. Names of models and coefficients.

CameraIntrinsics intrinsicsFrom(const double* numbers, CameraModel model, Resolution resolution_px);
void writeIntrinsics(const CameraIntrinsics& camera, double* numbers);

// Bounds of the nine numbers of a valid camera; infinite if unbounded.
struct IntrinsicsBounds {
  std::array<double, 9> lower, upper;
};
IntrinsicsBounds intrinsicsBounds(CameraModel model);

// "k1", "p1", ... by coefficient; empty for coefficients that the model does not have.
std::array<const char*, 5> distortionNames(CameraModel model);

// Largest number of coefficients; radtan omits the fifth (k3) if it is 0.
int coefficientCount(CameraModel model);

// Names of the models in files, in the order of CameraModel.
inline constexpr std::initializer_list<const char*> kCameraModelNames = {
    "pinhole_radtan", "pinhole_equidistant", "double_sphere", "eucm", "omni_radtan"};

const char* cameraModelName(CameraModel model);
const char* cameraModelTitle(CameraModel model);  // for display: "Pinhole, equidistant"

}  // namespace evical
