#include "core/frontend/active_event_surface.h"

namespace evical {

ActiveEventSurface::ActiveEventSurface(const BurstWindow& window, int border_px)
    : border_px_(border_px), stride_(window.resolution_px().width_px + 2 * border_px) {
  const int rows = window.resolution_px().height_px + 2 * border_px;
  for (std::vector<float>& plane : times_s_)
    plane.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows), kNever_s);
  pixels_.reserve(window.bursts().size());
  for (const WindowBurst& burst : window.bursts()) {
    const int x = static_cast<int>(burst.x_px), y = static_cast<int>(burst.y_px);
    const bool leading = burst.lead > 0.0f;
    float& time_s = times_s_[leading][static_cast<std::size_t>((y + border_px) * stride_ + x + border_px)];
    if (!active(time_s))
      pixels_.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), leading});
    if (burst.time_s > time_s) time_s = burst.time_s;
  }
}

}  // namespace evical
