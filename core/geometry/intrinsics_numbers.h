// Intrinsics as nine plain numbers, for solvers: in the order of IntrinsicsJacobian (camera_model.h), fx fy
// cx cy d0 d1 d2 d3 d4; pixels, and coefficients without unit.
#pragma once

#include "core/geometry/camera_intrinsics.h"

#include <array>

namespace evical {

CameraIntrinsics intrinsicsFrom(const double* numbers, CameraModel model, Resolution resolution_px);
void writeIntrinsics(const CameraIntrinsics& camera, double* numbers);

// "k1", "p1", ... by coefficient; empty where the model has none.
std::array<const char*, 5> distortionNames(CameraModel model);

}  // namespace evical
