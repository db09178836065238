// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/frustum_events.h"

#include "ui/scene/camera_shape.h"

#include <algorithm>

namespace evical::ui {
namespace {

constexpr std::size_t kMostPoints = 12000;

// Newest event by pixel.
std::vector<Event> newestByPixel(const std::vector<Event>& events, const Resolution& resolution_px) {
  const auto width = static_cast<std::size_t>(resolution_px.width_px);
  const auto height = static_cast<std::size_t>(resolution_px.height_px);
  std::vector<Event> newest;
  std::vector<bool> taken(width * height, false);
  for (auto event = events.rbegin(); event != events.rend(); ++event) {
    if (event->x_px >= width || event->y_px >= height) continue;
    const std::size_t pixel = event->y_px * width + event->x_px;
    if (taken[pixel]) continue;
    taken[pixel] = true;
    newest.push_back(*event);
  }
  return newest;
}

}  // namespace

std::vector<FrustumEvent> onImagePlane(const std::vector<Event>& events,
                                       const std::optional<CameraIntrinsics>& intrinsics) {
  if (!intrinsics || !intrinsics->resolution_px.known()) return {};
  const std::vector<Event> newest = newestByPixel(events, intrinsics->resolution_px);
  const std::size_t every = std::max<std::size_t>(1, (newest.size() + kMostPoints - 1) / kMostPoints);
  std::vector<FrustumEvent> points;
  for (std::size_t k = 0; k < newest.size(); k += every)
    points.push_back({rayAtUnitDepth(*intrinsics, {newest[k].x_px, newest[k].y_px}), newest[k].brighter});
  return points;
}

}  // namespace evical::ui
