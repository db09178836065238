// Ends a solve on a request to stop the run: its intermediate result must not be used, and the caller throws
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
