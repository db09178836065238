#include "core/geometry/camera_intrinsics.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace evical {

CameraIntrinsics intrinsicsFrom(const double* p, CameraModel model, Resolution resolution_px) {
  return {model, resolution_px, {p[0], p[1]}, {p[2], p[3]}, {p[4], p[5], p[6], p[7], p[8]}};
}

void writeIntrinsics(const CameraIntrinsics& camera, double* p) {
  std::copy_n(camera.focal_length_px.data(), 2, p);
  std::copy_n(camera.principal_point_px.data(), 2, p + 2);
  std::copy(camera.distortion.begin(), camera.distortion.end(), p + 4);
}

IntrinsicsBounds intrinsicsBounds(CameraModel model) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  IntrinsicsBounds bounds;
  bounds.lower.fill(-kAny);
  bounds.upper.fill(kAny);
  const auto bound = [&](std::size_t coefficient, double lower, double upper) {
    bounds.lower[4 + coefficient] = lower;
    bounds.upper[4 + coefficient] = upper;
  };
  constexpr double kLargestShift = 0.99;  // at 1 a sphere's centre is on the other sphere
  constexpr double kLargestBeta = 100.0, kLargestMirror = 100.0;
  if (model == CameraModel::DoubleSphere) {
    bound(0, -kLargestShift, kLargestShift);
    bound(1, 0.0, 1.0);
  }
  if (model == CameraModel::Eucm) {
    bound(0, 0.0, 1.0);
    bound(1, 1.0 / kLargestBeta, kLargestBeta);
  }
  if (model == CameraModel::OmniRadtan) bound(0, 0.0, kLargestMirror);
  return bounds;
}

std::array<const char*, 5> distortionNames(CameraModel model) {
  switch (model) {
    case CameraModel::PinholeRadtan:
      return {"k1", "k2", "p1", "p2", "k3"};
    case CameraModel::PinholeEquidistant:
      return {"k1", "k2", "k3", "k4", ""};
    case CameraModel::DoubleSphere:
      return {"xi", "alpha", "", "", ""};
    case CameraModel::Eucm:
      return {"alpha", "beta", "", "", ""};
    case CameraModel::OmniRadtan:
      break;
  }
  return {"xi", "k1", "k2", "p1", "p2"};
}

int coefficientCount(CameraModel model) {
  const auto names = distortionNames(model);
  return static_cast<int>(
      std::count_if(names.begin(), names.end(), [](const char* name) { return *name != '\0'; }));
}

const char* cameraModelName(CameraModel model) {
  return std::data(kCameraModelNames)[static_cast<std::size_t>(model)];
}

const char* cameraModelTitle(CameraModel model) {
  switch (model) {
    case CameraModel::PinholeRadtan:
      return "Pinhole, radial-tangential";
    case CameraModel::PinholeEquidistant:
      return "Pinhole, equidistant";
    case CameraModel::DoubleSphere:
      return "Double sphere";
    case CameraModel::Eucm:
      return "Enhanced unified (EUCM)";
    case CameraModel::OmniRadtan:
      break;
  }
  return "Omni, radial-tangential";
}

}  // namespace evical
