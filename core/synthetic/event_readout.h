// The arbiter through which all pixels' events leave a camera: one after the other.
#pragma once

#include "core/data/event.h"
#include "core/synthetic/scenario.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace evical {

class EventReadout {
 public:
  explicit EventReadout(const EventPixelModel& pixel);

  // Events in time order, packet after packet: stamps become those of their turns, and events that would have
  // to wait too long are dropped.
  void pass(std::vector<Event>& events);

 private:
  std::int64_t origin_ns_ = 0;  // of what is a floating-point number here
  double turn_ns_;              // 0: any number at once
  double longest_wait_ns_;
  double free_at_ns_ = -std::numeric_limits<double>::infinity();
};

}  // namespace evical
