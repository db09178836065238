// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/view_poses.h"

#include "core/initialisation/initialisation_options.h"

#include <algorithm>

namespace evical::ui {
namespace {

constexpr std::size_t kViewsAtOnce = 32;  // about 20 ms, for a prompt stop

bool continues(const ViewPoseInput& input, const ViewPoses& before) {
  if (before.views_done == 0) return false;
  if (before.of.intrinsics != input.intrinsics || before.of.board != input.board) return false;
  const SharedViews &old = before.of.views, &now = input.views;
  const std::size_t last = before.views_done - 1;
  return now.size() > last && now.front()->time_s == old.front()->time_s &&
         now[last]->time_s == old[last]->time_s;
}

}  // namespace

ViewPoses estimateViewPoses(const ViewPoseInput& input, const ViewPoses& before, std::stop_token stop) {
  ViewPoses result;
  if (continues(input, before)) result = before;
  result.of = input;
  const SharedViews& views = input.views;
  CameraData some{{}, givenLens(input.intrinsics), {}};
  while (result.views_done < views.size() && !stop.stop_requested()) {
    const std::size_t end = std::min(result.views_done + kViewsAtOnce, views.size());
    some.observations.views.clear();
    for (std::size_t k = result.views_done; k < end; ++k) some.observations.views.push_back(*views[k]);
    const CameraPoses found = estimateCameraPoses(some, input.board, InitialisationOptions{});
    for (CameraPose pose : found.poses) {
      pose.view += result.views_done;
      result.poses.push_back(pose);
    }
    result.views_done = end;
  }
  return result;
}

}  // namespace evical::ui
