// Events of a simulated camera, pixel by pixel from rendered log intensity.
#pragma once

#include "core/base/progress.h"
#include "core/data/event.h"
#include "core/synthetic/scenario.h"

#include <functional>

namespace evical {

using EventSink = std::function<void(EventSpan)>;

// Calls `sink` with packets of about 10 ms in time order; stamps are of the camera's clock, nanoseconds in
// the scenario's epoch, on whole microseconds. Deterministic from the seed for any number of threads. Bounded
// memory.
void simulateEvents(const Scenario& scenario, std::size_t camera, const EventSink& sink,
                    const RunContext& context = {}, int threads = 2);

}  // namespace evical
