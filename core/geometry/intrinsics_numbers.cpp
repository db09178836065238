#include "core/geometry/intrinsics_numbers.h"

#include <algorithm>

namespace evical {

CameraIntrinsics intrinsicsFrom(const double* p, CameraModel model, Resolution resolution_px) {
  return {model, resolution_px, {p[0], p[1]}, {p[2], p[3]}, {p[4], p[5], p[6], p[7], p[8]}};
}

void writeIntrinsics(const CameraIntrinsics& camera, double* p) {
  std::copy_n(camera.focal_length_px.data(), 2, p);
  std::copy_n(camera.principal_point_px.data(), 2, p + 2);
  std::copy(camera.distortion.begin(), camera.distortion.end(), p + 4);
}

std::array<const char*, 5> distortionNames(CameraModel model) {
  if (model == CameraModel::PinholeRadtan) return {"k1", "k2", "p1", "p2", "k3"};
  return {"k1", "k2", "k3", "k4", ""};
}

}  // namespace evical
