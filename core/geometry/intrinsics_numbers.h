// Intrinsics as nine plain numbers, for solvers: in the order of IntrinsicsJacobian (camera_model.h), fx fy
// cx cy d0 d1 d2 d3 d4; pixels, and coefficients without unit. What the models are called, and their coefficients.
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

// "k1", "p1", ... by coefficient; empty where the model has none.
std::array<const char*, 5> distortionNames(CameraModel model);

// At most; radtan does without the fifth (k3) where it is 0.
int coefficientCount(CameraModel model);

// Names of the models in files, in the order of CameraModel.
inline constexpr std::initializer_list<const char*> kCameraModelNames = {
    "pinhole_radtan", "pinhole_equidistant", "double_sphere", "eucm", "omni_radtan"};

const char* cameraModelName(CameraModel model);
const char* cameraModelTitle(CameraModel model);  // for people: "Pinhole, equidistant"

}  // namespace evical
