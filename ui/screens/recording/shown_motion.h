// SPDX-License-Identifier: GPL-3.0-or-later
// Motions that a recording needs, for animations: camera poses over ten seconds, repeated.
#pragma once

#include "core/geometry/rigid_transform.h"

#include <QString>

#include <vector>

namespace evical::ui {

inline constexpr double kShownMotion_s = 10.0;
// Distance from the camera's rest position to the board in the drawing's world; x to the right, y down.
inline constexpr double kShownDistance_m = 0.6;

struct ShownMotion {
  QString name, title, words;  // name for programs; words: instructions and reasons
  // Pose at a share of the ten seconds; the drawing's world is the camera's frame at rest.
  RigidTransform (*world_from_camera)(double share) = nullptr;
  // Point of the camera, in its frame, whose path is drawn as an arrow.
  Eigen::Vector3d followed = Eigen::Vector3d::Zero();
};

const std::vector<ShownMotion>& shownMotions();

}  // namespace evical::ui
