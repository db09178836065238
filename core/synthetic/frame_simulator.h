// Frames of a simulated camera: the board and its background, with lens blur and motion blur of exposures.
#pragma once

#include "core/base/progress.h"
#include "core/data/frame.h"
#include "core/synthetic/scenario.h"

#include <cstddef>
#include <functional>

namespace evical {

// Calls `sink` with frames in order of time, 8 bit, stamped with the middle of the middle row's exposure
// on the camera's clock. Deterministic from the seed, for any number of threads. The camera must have
// `frames`.
void simulateFrames(const Scenario& scenario, std::size_t camera,
                    const std::function<void(const Frame&)>& sink, const RunContext& context = {},
                    int threads = 2);

}  // namespace evical
