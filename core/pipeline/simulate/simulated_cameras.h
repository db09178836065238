// Events of all event cameras of a scenario as one stream in order of time, a thread a camera.
#pragma once

#include "core/base/progress.h"
#include "core/data/event.h"
#include "core/synthetic/scenario.h"

#include <cstddef>
#include <functional>

namespace evical {

// Calls `sink` in the caller's thread with packets of about 10 ms; throws what it or a simulation throws.
void simulateCameras(const Scenario& scenario,
                     const std::function<void(std::size_t camera, EventSpan events)>& sink,
                     const RunContext& context);

}  // namespace evical
