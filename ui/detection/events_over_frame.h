// SPDX-License-Identifier: GPL-3.0-or-later
// Projects events into a frame camera through a calibration: from the event's pixel along its ray to the
// board's plane, with the camera's pose at the event's own time, and from there into the frame camera with
// its pose at the frame's time. On the board, events coincide with the edges in the frame if lenses, poses
// and time offsets are correct; events outside the board's plane are misplaced. For a bent board, the plane
// is the tangent at its origin.
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

// Times are on a camera's own clock, since the recording's start.
class EventsOverFrame {
 public:
  // The lenses of both cameras must be known: see isPossible.
  EventsOverFrame(std::shared_ptr<const CalibrationState> state, std::size_t events_camera,
                  std::size_t frames_camera, Resolution events_px);
  bool isOf(const std::shared_ptr<const CalibrationState>& state, std::size_t events_camera,
            std::size_t frames_camera, Resolution events_px) const {
    return state == state_ && events_camera == events_camera_ && frames_camera == frames_camera_ &&
           events_px == events_px_;
  }
  static bool isPossible(const CalibrationState& state, std::size_t events_camera, std::size_t frames_camera);

  // Time of the frame's middle row, for the following events.
  void setFrameTime(double time_s);
  // None outside the trajectory, or if the plane is not visible.
  std::optional<Eigen::Vector2d> pixelOf(int x_px, int y_px, double time_s);

  // Time on the event camera's clock at which the frame was taken; events up to then are shown.
  double eventTime_s(double frame_time_s) const;
  // Width in frame pixels that an event's pixel covers.
  int pixelsOfEvent() const;

 private:
  const CameraState& events() const { return state_->cameras[events_camera_]; }
  const CameraState& frames() const { return state_->cameras[frames_camera_]; }
  std::optional<Eigen::Vector2d> inFrame(const Eigen::Vector3d& point_in_world) const;

  std::shared_ptr<const CalibrationState> state_;
  std::size_t events_camera_, frames_camera_;
  Resolution events_px_;
  std::vector<Eigen::Vector3f> rays_;  // by event pixel; 0: no ray
  double frame_time_s_ = 0.0;
  std::optional<RigidTransform> frame_camera_from_world_;
  std::int64_t pose_step_ = 0;  // index of the cached pose
  std::optional<RigidTransform> world_from_event_camera_;
};

// Paints the dimmed frame and the events over it, the newest on top, fading with age. `start_ns` is the
// recording's; events in order of time. Returns the number of visible events.
std::size_t paintEventsOver(EventsOverFrame& transfer, EventSpan events, std::int64_t start_ns,
                            double frame_time_s, const SurfaceStyle& style, QImage& frame);

}  // namespace evical::ui
