// History of an intrinsics calibration, for display; not part of results and their files.
#pragma once

#include "core/geometry/camera_intrinsics.h"

#include <vector>

namespace evical {

// A tested model, and how well it explained the views.
struct TriedModel {
  CameraModel model = CameraModel::PinholeRadtan;
  double spread_sigma = 0.0;  // median-based spread of normalised errors
  int circles_used = 0, circles = 0;
};

// Pose of the board in a used view.
struct IntrinsicsView {
  double time_s = 0.0;
  double distance_m = 0.0;  // from the camera to the board's middle
  double tilt_deg = 0.0;    // of the board relative to the image plane
  int circles = 0;          // used
  double reprojection_rms_px = 0.0;
};

struct IntrinsicsStory {
  std::vector<TriedModel> tried;      // includes the selected one; empty if the model was not changed
  std::vector<IntrinsicsView> views;  // in order of time
};

}  // namespace evical
