// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/sample_scene.h"

#include "ui/scene/trajectory_scene.h"

namespace evical::ui {

void addSampleScene(vtkRenderer* renderer) {
  const RigidTransform pose{Eigen::Quaterniond::Identity(), {0.0, 0.0, -0.5}};
  auto track = std::make_shared<TrajectoryTrack>();
  for (const double time_s : {0.0, 1.0, 2.0}) {
    track->times_s.push_back(time_s);
    track->positions_m.emplace_back(0.1 * time_s, 0.0, -0.5);
    track->speeds_m_s.push_back(time_s);
  }
  track->stations.push_back({0.0, {pose}});
  TrajectoryScene scene(renderer);  // its additions stay with the renderer
  scene.setBoard(Board{});
  scene.setTrack(track);
  scene.setGravity(Eigen::Vector3d(0.0, 9.81, 0.0));
  scene.setRawPoses({pose});
  scene.setInstant({pose}, {pose});
}

}  // namespace evical::ui
