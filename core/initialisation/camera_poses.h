// Camera poses from single views of the board (docs/maths.md, 8.2).
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_setup.h"
#include "core/geometry/rigid_transform.h"
#include "core/initialisation/gyro_rotation.h"
#include "core/initialisation/initialisation_options.h"

#include <optional>
#include <vector>

namespace evical {

struct CameraPose {
  double time_s = 0.0;  // camera clock
  RigidTransform world_from_camera;
  double reprojection_px = 0.0;  // RMS
  std::size_t view = 0;          // index into the observations' views
  // The other pose that a plane allows, where it fits hardly worse.
  std::optional<RigidTransform> other_world_from_camera;
};

struct CameraPoses {
  std::vector<CameraPose> poses;
  int rejected = 0;                     // views that fit worse than the option allows, or not at all
  double median_reprojection_px = 0.0;  // of all views, those too
};

// One pose a view, its circles brought to view.time_s.
CameraPoses estimateCameraPoses(const CameraData& camera, const Board& board,
                                const InitialisationOptions& options, const RunContext& context = {});

// If a view allows two poses, takes the one whose rotation from its neighbours is as large as the
// gyroscope's. Returns the number of swapped ones.
int resolveAmbiguousPoses(std::vector<CameraPose>& poses, const GyroRotation& gyro, double time_offset_s,
                          double longest_pair_s);

}  // namespace evical
