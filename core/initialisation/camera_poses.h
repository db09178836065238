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
  // The other pose that a plane allows, if it fits almost equally well.
  std::optional<RigidTransform> other_world_from_camera;
};

struct CameraPoses {
  std::vector<CameraPose> poses;
  int rejected = 0;                     // views with errors above the option's limit, or without a fit
  double median_reprojection_px = 0.0;  // of all views, including rejected ones
};

// One pose per view, with circles moved to view.time_s.
CameraPoses estimateCameraPoses(const CameraData& camera, const Board& board,
                                const InitialisationOptions& options, const RunContext& context = {});

// For views with two possible poses, selects the one whose rotation relative to its neighbours has the
// gyroscope's magnitude. Returns the number of swapped ones.
int resolveAmbiguousPoses(std::vector<CameraPose>& poses, const GyroRotation& gyro, double time_offset_s,
                          double longest_pair_s);

}  // namespace evical
