// Events of a simulated camera, pixel by pixel from rendered log intensity.
#pragma once

#include "core/base/progress.h"
#include "core/data/event.h"
#include "core/synthetic/scenario.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace evical {

using EventSink = std::function<void(EventSpan)>;

// Calls `sink` with packets of about 10 ms in time order; stamps are of the camera's clock, nanoseconds in
// the scenario's epoch, on whole microseconds. Deterministic from the seed for any number of threads. Bounded
// memory.
void simulateEvents(const Scenario& scenario, std::size_t camera, const EventSink& sink,
                    const RunContext& context = {}, int threads = 2);

// The arbiter that reads out all pixels' events one after the other.
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
