// The arbiter that reads out all pixels' events one after the other.
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

  // Events in time order, packet after packet: their stamps become the readout times, and events that would
  // have to wait too long are dropped.
  void pass(std::vector<Event>& events);

 private:
  std::int64_t origin_ns_ = 0;  // origin of floating-point times
  double turn_ns_;              // 0: unlimited
  double longest_wait_ns_;
  double free_at_ns_ = -std::numeric_limits<double>::infinity();
};

}  // namespace evical
