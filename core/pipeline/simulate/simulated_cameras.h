// Events of all event cameras of a scenario as one stream in time order, with one thread per camera.
#pragma once

#include "core/base/progress.h"
#include "core/data/event.h"
#include "core/synthetic/scenario.h"

#include <cstddef>
#include <functional>

namespace evical {

// Calls `sink` in the caller's thread with packets of about 10 ms; rethrows exceptions of `sink` and the
// simulations.
void simulateCameras(const Scenario& scenario,
                     const std::function<void(std::size_t camera, EventSpan events)>& sink,
                     const RunContext& context);

}  // namespace evical
