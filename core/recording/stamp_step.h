// Step of the time stamps of events. Some drivers and files round them to ms, and give thousands of events
// the same stamp.
#pragma once

#include "core/base/time.h"
#include "core/data/event.h"

#include <cstddef>
#include <cstdint>
#include <limits>

namespace evical {

class StampStep {
 public:
  // Call in order of time. Only the first events are checked.
  void add(EventSpan events) {
    constexpr std::uint64_t kMost = 500'000;
    for (const Event& event : events) {
      if (seen_ >= kMost || step_ns_ <= kFine_ns) return;
      const std::int64_t step_ns = event.time_ns - last_ns_;
      if (seen_++ > 0 && step_ns > 0) {
        ++steps_;
        if (step_ns < step_ns_) step_ns_ = step_ns;
      }
      last_ns_ = event.time_ns;
    }
  }

  // 0 if stamps have the sensor's resolution.
  double step_s() const {
    constexpr std::uint64_t kFewestSteps = 20, kFewestAlike = 3;
    const bool coarse = step_ns_ > kFine_ns && steps_ >= kFewestSteps && seen_ >= kFewestAlike * steps_;
    return coarse ? 1e-9 * static_cast<double>(step_ns_) : 0.0;
  }

 private:
  static constexpr std::int64_t kFine_ns = 100'000;  // a tenth of a good recording's time offset sigma

  std::uint64_t seen_ = 0, steps_ = 0;
  std::int64_t last_ns_ = 0, step_ns_ = std::numeric_limits<std::int64_t>::max();
};

}  // namespace evical
