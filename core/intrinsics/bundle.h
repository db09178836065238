// Bundle adjustment: intrinsics, edge lead, and a pose for every view.
#pragma once

#include "core/base/progress.h"
#include "core/geometry/board.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/rigid_transform.h"
#include "core/intrinsics/sensor_views.h"

#include <array>
#include <vector>

namespace evical {

using FreeIntrinsics = std::array<bool, 9>;  // which of fx fy cx cy d0..d4 are estimated
FreeIntrinsics freeIntrinsics(CameraModel model, const IntrinsicsOptions& options);

struct Bundle {
  CameraIntrinsics intrinsics;
  double edge_lead_px = 0.0;
  std::vector<SensorView> views;      // with what is used of them
  std::vector<RigidTransform> poses;  // camera_from_board, by view
  double scale = 1.0;                 // spread of the errors in units of their sigmas, from the median
  bool converged = false;
  double radius_m = 0.0;  // of the board's circles

  // Predicted - measured, edge lead included; 1000 px where the camera does not see it.
  Eigen::Vector2d error_px(std::size_t view, const SensorCircle& circle) const;
  int circlesUsed() const;
  int viewsUsed() const;
};

// From a start and views; rounds of solving, with weights and outliers as the errors show them.
Bundle solveBundle(const CameraIntrinsics& start, const std::vector<SensorView>& views, const Board& board,
                   const IntrinsicsOptions& options, const RunContext& context);

}  // namespace evical
