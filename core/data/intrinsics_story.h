// How intrinsics came about: for who shows a calibration of a camera alone; results and their files go without.
#pragma once

#include "core/geometry/camera_intrinsics.h"

#include <vector>

namespace evical {

// A model that the views were explained with, and how well.
struct TriedModel {
  CameraModel model = CameraModel::PinholeRadtan;
  double spread_sigma = 0.0;  // of the errors in units of their sigmas, from the median
  int circles_used = 0, circles = 0;
};

// Where the board was in a view that is used.
struct IntrinsicsView {
  double time_s = 0.0;
  double distance_m = 0.0;  // from the camera to the board's middle
  double tilt_deg = 0.0;    // of the board against the image
  int circles = 0;          // used
  double reprojection_rms_px = 0.0;
};

struct IntrinsicsStory {
  std::vector<TriedModel> tried;      // the one taken among them; none where the model was kept
  std::vector<IntrinsicsView> views;  // in order of time
};

}  // namespace evical
