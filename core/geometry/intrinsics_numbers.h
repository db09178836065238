// Intrinsics as nine plain numbers, for solvers: in the order of IntrinsicsJacobian (camera_model.h), fx fy
// cx cy d0 d1 d2 d3 d4; pixels, and coefficients without unit. Names of models and coefficients.
#pragma once

#include "core/geometry/camera_intrinsics.h"

#include <array>
#include <initializer_list>

namespace evical {

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
