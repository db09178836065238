#include "core/foreign/read_pair.h"

#include "core/base/error.h"

#include <limits>

namespace evical {
namespace {

bool sameNumbers(CameraIntrinsics a, const CameraIntrinsics& b) {
  a.resolution_px = b.resolution_px;
  return a == b;
}

// Adds metres and radians: it only distinguishes cameras.
double distance(const RigidTransform& a, const RigidTransform& b) {
  return (a.translation_m - b.translation_m).norm() + a.rotation.angularDistance(b.rotation);
}

ReadCamera placed(const ReadCamera& camera, const CameraIntrinsics& lens,
                  const RigidTransform& left_from_camera) {
  ReadCamera read;
  read.name = camera.name;
  read.lens = lens;
  read.frame_from_camera = left_from_camera;
  return read;
}

}  // namespace

ReadFile pairAmong(std::span<const ReadCamera> cameras, const PairAsRead& pair,
                   const std::filesystem::path& path) {
  const ReadCamera* best_left = nullptr;
  const ReadCamera* best_right = nullptr;
  double nearest = std::numeric_limits<double>::infinity();
  for (const ReadCamera& left : cameras)
    for (const ReadCamera& right : cameras) {
      if (&left == &right || !sameNumbers(*left.lens, pair.left) || !sameNumbers(*right.lens, pair.right))
        continue;
      const double off =
          distance(inverse(*right.frame_from_camera) * *left.frame_from_camera, pair.right_from_left);
      if (!(off < nearest)) continue;
      nearest = off;
      best_left = &left;
      best_right = &right;
    }
  if (best_left == nullptr)
    throw badInput(path.string(), "left or right has a lens that no camera's own file has");
  ReadFile file{
      path,
      {placed(*best_left, pair.left, {}), placed(*best_right, pair.right, inverse(pair.right_from_left))}};
  file.about_first_camera = true;
  return file;
}

}  // namespace evical
