// SPDX-License-Identifier: GPL-3.0-or-later
// Events where a frame camera sees them, through a calibration: from the event's pixel along its ray to the board's
// plane, with the camera where the trajectory has it at the event's own time, and from there into the frame camera,
// where that is at the frame's time. On the board's edges they lie where the frame has its edges, if lenses, poses and
// time offsets are right; what does not lie in the board's plane is carried to a wrong place. Of a board that is bent
// the plane is the one that touches it at its origin.
#pragma once

#include "core/data/calibration_state.h"
#include "core/data/event.h"
#include "core/geometry/resolution.h"
#include "ui/detection/surface_frame.h"

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <vector>

namespace evical::ui {

// Times are of a camera's own clock, since the recording's start.
class EventsOverFrame {
 public:
  // Both cameras' lenses must be known: see isPossible.
  EventsOverFrame(std::shared_ptr<const CalibrationState> state, std::size_t events_camera,
                  std::size_t frames_camera, Resolution events_px);
  bool isOf(const std::shared_ptr<const CalibrationState>& state, std::size_t events_camera,
            std::size_t frames_camera, Resolution events_px) const {
    return state == state_ && events_camera == events_camera_ && frames_camera == frames_camera_ &&
           events_px == events_px_;
  }
  static bool isPossible(const CalibrationState& state, std::size_t events_camera, std::size_t frames_camera);

  // Of the middle row of the frame; the next events are for this one.
  void setFrameTime(double time_s);
  // Nothing outside the trajectory, and where the plane is not in sight.
  std::optional<Eigen::Vector2d> pixelOf(int x_px, int y_px, double time_s);

  // The event camera's time at which the frame was taken; events are shown up to then.
  double eventTime_s(double frame_time_s) const;
  // Pixels of the frame that an event's pixel covers, across.
  int pixelsOfEvent() const;

 private:
  const CameraState& events() const { return state_->cameras[events_camera_]; }
  const CameraState& frames() const { return state_->cameras[frames_camera_]; }
  std::optional<Eigen::Vector2d> inFrame(const Eigen::Vector3d& point_in_world) const;

  std::shared_ptr<const CalibrationState> state_;
  std::size_t events_camera_, frames_camera_;
  Resolution events_px_;
  std::vector<Eigen::Vector3f> rays_;  // by event pixel; 0: it sees nothing
  double frame_time_s_ = 0.0;
  std::optional<RigidTransform> frame_camera_from_world_;
  std::int64_t pose_step_ = 0;  // which the next pose is of
  std::optional<RigidTransform> world_from_event_camera_;
};

// The frame, fainter, and over it the events, their newest on top, fading with age. `start_ns` is the recording's;
// events in order of time. Returns how many are in sight.
std::size_t paintEventsOver(EventsOverFrame& transfer, EventSpan events, std::int64_t start_ns,
                            double frame_time_s, const SurfaceStyle& style, QImage& frame);

}  // namespace evical::ui
