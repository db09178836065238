// SPDX-License-Identifier: GPL-3.0-or-later
// The motions that a recording needs, as drawings show them: where the camera is, ten seconds long, over and over.
#pragma once

#include "core/geometry/rigid_transform.h"

#include <QString>

#include <vector>

namespace evical::ui {

inline constexpr double kShownMotion_s = 10.0;
// From the camera's middle place to the board, which lies at z = this in the drawing's world; x to the right, y down.
inline constexpr double kShownDistance_m = 0.6;

struct ShownMotion {
  QString name, title, words;  // the first for programs, the last says how and why
  // At a share of the ten seconds; the drawing's world is the camera's frame at rest.
  RigidTransform (*world_from_camera)(double share) = nullptr;
  // Drawn with its way as an arrow: a point of the camera, in its frame.
  Eigen::Vector3d followed = Eigen::Vector3d::Zero();
};

const std::vector<ShownMotion>& shownMotions();

}  // namespace evical::ui
