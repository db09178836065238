// Detects a camera at the limit of its read-out. It loses events, and the others get late timestamps.
#pragma once

#include "core/data/event.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace evical {

// Counts events in windows of 10 ms. At its limit a read-out gives the same count in many windows; a scene
// does not.
class ReadOutLoad {
 public:
  // Call in order of time.
  void add(EventSpan events) {
    for (auto event = events.begin(); event != events.end();) {
      const std::int64_t bin = event->time_ns / kBin_ns;
      const auto end =
          std::lower_bound(event, events.end(), (bin + 1) * kBin_ns,
                           [](const Event& e, std::int64_t time_ns) { return e.time_ns < time_ns; });
      if (counts_.empty() || bin != last_bin_) counts_.push_back(0);
      last_bin_ = bin;
      counts_.back() += static_cast<std::uint32_t>(end - event);
      event = end;
    }
  }

  struct Limit {
    double rate_hz = 0.0;
    double share = 0.0;  // of the time at the limit; 0 if there is no limit
  };
  Limit limit() const {
    constexpr std::size_t kFewest = 100;
    constexpr double kMinRate_hz = 1e6, kNear = 0.02, kMinShare = 0.15;
    if (counts_.size() < kFewest) return {};
    std::vector<std::uint32_t> sorted = counts_;
    const auto top = sorted.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(sorted.size()));
    std::nth_element(sorted.begin(), top, sorted.end());
    const double most = *top;
    const auto near = std::count_if(counts_.begin(), counts_.end(),
                                    [&](std::uint32_t count) { return count >= (1.0 - kNear) * most; });
    const Limit found{most * 1e9 / static_cast<double>(kBin_ns),
                      static_cast<double>(near) / static_cast<double>(counts_.size())};
    return found.rate_hz >= kMinRate_hz && found.share >= kMinShare ? found : Limit{};
  }

 private:
  static constexpr std::int64_t kBin_ns = 10'000'000;

  std::vector<std::uint32_t> counts_;
  std::int64_t last_bin_ = 0;
};

}  // namespace evical
