// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/events_over_frame.h"

#include "core/base/time.h"
#include "core/geometry/camera_model.h"
#include "ui/detection/trajectory_pose.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical::ui {
namespace {

constexpr double kPoseStep_s = 1e-4;  // the fastest motion by hand is a tenth of a pixel

std::vector<Eigen::Vector3f> raysOf(const CameraIntrinsics& lens, Resolution size_px) {
  std::vector<Eigen::Vector3f> rays;
  rays.reserve(static_cast<std::size_t>(size_px.pixelCount()));
  for (int y = 0; y < size_px.height_px; ++y) {
    for (int x = 0; x < size_px.width_px; ++x) {
      const auto ray = unprojectRay(lens, Eigen::Vector2d(x, y));
      rays.push_back(ray ? Eigen::Vector3f(ray->cast<float>()) : Eigen::Vector3f(Eigen::Vector3f::Zero()));
    }
  }
  return rays;
}

void dim(QImage& image, double part) {
  for (int y = 0; y < image.height(); ++y) {
    auto* row = reinterpret_cast<QRgb*>(image.scanLine(y));
    for (int x = 0; x < image.width(); ++x) {
      const auto grey = static_cast<int>(part * qGray(row[x]));
      row[x] = qRgb(grey, grey, grey);
    }
  }
}

void mixInto(QRgb& pixel, QRgb colour, double part) {
  const auto channel = [part](int a, int b) { return static_cast<int>(std::lround(a + part * (b - a))); };
  pixel = qRgb(channel(qRed(pixel), qRed(colour)), channel(qGreen(pixel), qGreen(colour)),
               channel(qBlue(pixel), qBlue(colour)));
}

// Newest event of each pixel of the frame.
struct NewestEvents {
  static constexpr float kNone = -1.0F;
  int width, height;
  std::vector<float> age_s;
  std::vector<bool> brighter;

  explicit NewestEvents(const QImage& frame)
      : width(frame.width()),
        height(frame.height()),
        age_s(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kNone),
        brighter(age_s.size(), false) {}

  void add(const Eigen::Vector2d& at_px, int size, double age, bool is_brighter) {
    const auto left = static_cast<int>(std::lround(at_px.x() - 0.5 * (size - 1)));
    const auto top = static_cast<int>(std::lround(at_px.y() - 0.5 * (size - 1)));
    for (int y = std::max(0, top); y < std::min(height, top + size); ++y) {
      for (int x = std::max(0, left); x < std::min(width, left + size); ++x) {
        const std::size_t k =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
        age_s[k] = static_cast<float>(age);
        brighter[k] = is_brighter;
      }
    }
  }
  void paint(const SurfaceStyle& style, QImage& frame) const {
    std::size_t k = 0;
    for (int y = 0; y < height; ++y) {
      auto* row = reinterpret_cast<QRgb*>(frame.scanLine(y));
      for (int x = 0; x < width; ++x, ++k) {
        if (age_s[k] < 0.0F) continue;
        mixInto(row[x], brighter[k] ? style.brighter : style.darker,
                std::exp(-static_cast<double>(age_s[k]) / style.decay_s));
      }
    }
  }
};

}  // namespace

bool EventsOverFrame::isPossible(const CalibrationState& state, std::size_t events_camera,
                                 std::size_t frames_camera) {
  const auto seen = [&](std::size_t camera) {
    return camera < state.cameras.size() && state.cameras[camera].lens.inUse().has_value();
  };
  return seen(events_camera) && seen(frames_camera) && state.world_from_imu_rotation.segmentCount() > 0;
}

EventsOverFrame::EventsOverFrame(std::shared_ptr<const CalibrationState> state, std::size_t events_camera,
                                 std::size_t frames_camera, Resolution events_px)
    : state_(std::move(state)),
      events_camera_(events_camera),
      frames_camera_(frames_camera),
      events_px_(events_px),
      rays_(raysOf(*events().lens.inUse(), events_px)) {}

void EventsOverFrame::setFrameTime(double time_s) {
  frame_time_s_ = time_s;
  frame_camera_from_world_ = cameraFromWorldAt(*state_, frames(), time_s);
}

double EventsOverFrame::eventTime_s(double frame_time_s) const {
  return timeOnClockOf_s(events(), frames(), frame_time_s);
}

int EventsOverFrame::pixelsOfEvent() const {
  constexpr double kMax = 8.0;
  const double times =
      frames().lens.inUse()->focal_length_px.mean() / events().lens.inUse()->focal_length_px.mean();
  return static_cast<int>(std::lround(std::clamp(times, 1.0, kMax)));
}

// For a rolling shutter: exposure time of the row in which the point is seen.
std::optional<Eigen::Vector2d> EventsOverFrame::inFrame(const Eigen::Vector3d& point_in_world) const {
  const CameraIntrinsics& lens = *frames().lens.inUse();
  const auto pixel = project(lens, *frame_camera_from_world_ * point_in_world);
  if (!pixel || frames().line_delay_us == 0.0) return pixel;
  const auto then = cameraFromWorldAt(*state_, frames(), rowTime_s(frames(), frame_time_s_, pixel->y()));
  return then ? project(lens, *then * point_in_world) : pixel;
}

std::optional<Eigen::Vector2d> EventsOverFrame::pixelOf(int x_px, int y_px, double time_s) {
  const auto step = static_cast<std::int64_t>(std::lround(time_s / kPoseStep_s));
  if (!world_from_event_camera_ || step != pose_step_) {
    pose_step_ = step;
    const auto camera_from_world =
        cameraFromWorldAt(*state_, events(), static_cast<double>(step) * kPoseStep_s);
    world_from_event_camera_.reset();
    if (camera_from_world) world_from_event_camera_ = inverse(*camera_from_world);
  }
  if (!world_from_event_camera_ || !frame_camera_from_world_) return std::nullopt;
  const Eigen::Vector3d ray =
      rays_[static_cast<std::size_t>(y_px) * static_cast<std::size_t>(events_px_.width_px) +
            static_cast<std::size_t>(x_px)]
          .cast<double>();
  const Eigen::Vector3d direction = world_from_event_camera_->rotation * ray;
  const Eigen::Vector3d& eye = world_from_event_camera_->translation_m;
  const double length = -eye.z() / direction.z();  // the board's plane is z = 0
  if (!std::isfinite(length) || length <= 0.0) return std::nullopt;
  return inFrame(eye + length * direction);
}

std::size_t paintEventsOver(EventsOverFrame& transfer, EventSpan events, std::int64_t start_ns,
                            double frame_time_s, const SurfaceStyle& style, QImage& frame) {
  constexpr double kFaint = 0.7;
  dim(frame, kFaint);
  transfer.setFrameTime(frame_time_s);
  const double until_s = transfer.eventTime_s(frame_time_s);
  const int size = transfer.pixelsOfEvent();
  std::size_t count = 0;
  NewestEvents newest(frame);
  for (const Event& event : events) {
    const double time_s = secondsSince(start_ns, event.time_ns);
    if (time_s > until_s) break;
    const auto at_px = transfer.pixelOf(event.x_px, event.y_px, time_s);
    if (!at_px) continue;
    newest.add(*at_px, size, until_s - time_s, event.brighter);
    ++count;
  }
  newest.paint(style, frame);
  return count;
}

}  // namespace evical::ui
