// SPDX-License-Identifier: GPL-3.0-or-later
// The events around an instant, as they lie on the image plane of the camera's frustum.
#pragma once

#include "core/data/event.h"
#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <vector>

namespace evical::ui {

// A camera's events of any time; what it is asked in goes on in another thread.
struct EventLookup {
  std::size_t camera = 0;
  std::function<std::vector<Event>(double begin_s, double end_s)> between = {};  // none: nothing is known
};

struct FrustumEvent {
  Eigen::Vector3d at;  // in the camera frame, at z = 1
  bool brighter = false;
};

struct FrustumEvents {
  std::size_t camera = 0;
  std::vector<FrustumEvent> events;
};

// One a pixel, its newest; of very many every few, so that a frame stays fast. Empty without a lens.
std::vector<FrustumEvent> onImagePlane(const std::vector<Event>& events,
                                       const std::optional<CameraIntrinsics>& intrinsics);

}  // namespace evical::ui
