// Ends a solve when its run is asked to stop: what it had by then is of no use, and who started it throws
// Cancelled (RunContext::throwIfStopped).
#pragma once

#include <memory>
#include <stop_token>

namespace ceres {
class IterationCallback;
}

namespace evical {

// For ceres::Solver::Options::callbacks, which do not own it.
std::unique_ptr<ceres::IterationCallback> stopCallback(std::stop_token stop);

}  // namespace evical
