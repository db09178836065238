// Files of a stereo pair that name left and right, but not the cameras of the rig.
#pragma once

#include "core/foreign/read_calibration.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/rigid_transform.h"

#include <filesystem>
#include <span>

namespace evical {

struct PairAsRead {
  CameraIntrinsics left, right;  // resolutions are not compared
  RigidTransform right_from_left;
};

// Those two of `cameras`, read from their own files, that have the pair's lenses; if several have the same
// numbers, those with the closest poses. Throws CalibrationError (BadInput) if there are none; `path` is the
// pair's file.
ReadFile pairAmong(std::span<const ReadCamera> cameras, const PairAsRead& pair,
                   const std::filesystem::path& path);

}  // namespace evical
