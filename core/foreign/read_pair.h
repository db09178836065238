// Files of a stereo pair that say left and right, but not which camera of the rig either is.
#pragma once

#include "core/foreign/read_calibration.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/rigid_transform.h"

#include <filesystem>
#include <span>

namespace evical {

struct PairAsRead {
  CameraIntrinsics left, right;  // resolutions are not looked at
  RigidTransform right_from_left;
};

// Of `cameras`, read from their own files, those two that have the pair's lenses; where several have the same numbers,
// those whose own poses come nearest. Throws CalibrationError (BadInput) where there are none; `path` is the pair's file.
ReadFile pairAmong(std::span<const ReadCamera> cameras, const PairAsRead& pair,
                   const std::filesystem::path& path);

}  // namespace evical
