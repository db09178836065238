#include "core/synthetic/event_readout.h"

#include <algorithm>
#include <cmath>

namespace evical {

EventReadout::EventReadout(const EventPixelModel& pixel)
    : turn_ns_(pixel.readout_rate_hz > 0.0 ? 1e9 / pixel.readout_rate_hz : 0.0),
      longest_wait_ns_(1e9 * pixel.longest_wait_s) {}

void EventReadout::pass(std::vector<Event>& events) {
  if (turn_ns_ <= 0.0) return;
  if (origin_ns_ == 0 && !events.empty()) origin_ns_ = events.front().time_ns;
  std::erase_if(events, [&](Event& event) {
    const double time_ns = static_cast<double>(event.time_ns - origin_ns_);
    const double turn_ns = std::max(time_ns, free_at_ns_);
    if (turn_ns - time_ns > longest_wait_ns_) return true;
    free_at_ns_ = turn_ns + turn_ns_;
    event.time_ns = origin_ns_ + 1000 * std::llround(1e-3 * turn_ns);
    return false;
  });
}

}  // namespace evical
