// Bundle adjustment: intrinsics, edge localisation bias, and a pose for every view.
#pragma once

#include "core/base/progress.h"
#include "core/geometry/board.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/so3.h"
#include "core/intrinsics/sensor_views.h"

#include <array>
#include <vector>

namespace evical {

using FreeIntrinsics = std::array<bool, 9>;  // which of fx fy cx cy d0..d4 are estimated
FreeIntrinsics freeIntrinsics(CameraModel model, const IntrinsicsOptions& options);

struct Bundle {
  CameraIntrinsics intrinsics;
  double edge_localisation_bias_px = 0.0;
  std::vector<SensorView> views;      // with marks of used circles
  std::vector<RigidTransform> poses;  // camera_from_board, by view
  double scale = 1.0;                 // median-based spread of the normalised errors
  bool converged = false;
  double radius_m = 0.0;  // of the board's circles

  // Predicted minus measured, with the edge localisation bias; 1000 px if the camera does not see it.
  Eigen::Vector2d error_px(std::size_t view, const SensorCircle& circle) const;
  int circlesUsed() const;
  int viewsUsed() const;
};

// Estimate from a start value and views; iterates solutions and updates of weights and outliers.
Bundle solveBundle(const CameraIntrinsics& start, const std::vector<SensorView>& views, const Board& board,
                   const IntrinsicsOptions& options, const RunContext& context);

}  // namespace evical
