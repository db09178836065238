// SPDX-License-Identifier: GPL-3.0-or-later
// Camera poses from single board views, computed once each during the detection. Without VTK and widgets; for
// worker threads.
#pragma once

#include "core/initialisation/camera_poses.h"
#include "ui/jobs/live_view.h"

#include <stop_token>
#include <vector>

namespace evical::ui {

struct ViewPoseInput {
  SharedViews views;
  CameraIntrinsics intrinsics;
  Board board;
};

struct ViewPoses {
  std::vector<CameraPose> poses;
  ViewPoseInput of;
  std::size_t views_done = 0;
};

// Continues from `before` if its views are the first of these; otherwise from the start.
ViewPoses estimateViewPoses(const ViewPoseInput& input, const ViewPoses& before, std::stop_token stop);

}  // namespace evical::ui
