// SPDX-License-Identifier: GPL-3.0-or-later
// Events around the cursor's time on the image plane of the camera's frustum.
#pragma once

#include "core/data/event.h"
#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <vector>

namespace evical::ui {

// Access to a camera's events by time, usable in another thread.
struct EventLookup {
  std::size_t camera = 0;
  std::function<std::vector<Event>(double begin_s, double end_s)> between = {};  // none: no events
};

struct FrustumEvent {
  Eigen::Vector3d at;  // in the camera frame, at z = 1
  bool brighter = false;
};

struct FrustumEvents {
  std::size_t camera = 0;
  std::vector<FrustumEvent> events;
};

// The newest event of each pixel; thinned out if there are very many, to keep the frame rate. Empty without a
// lens.
std::vector<FrustumEvent> onImagePlane(const std::vector<Event>& events,
                                       const std::optional<CameraIntrinsics>& intrinsics);

}  // namespace evical::ui
