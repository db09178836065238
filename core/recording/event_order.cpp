#include "core/recording/event_order.h"

#include "core/base/number.h"

#include <fmt/format.h>

#include <algorithm>

namespace evical {
std::size_t EventOrder::arrange(std::span<Event> events) {
  const std::uint64_t before = disordered_;
  std::size_t end = events.empty() ? 0 : 1;
  for (; end < events.size(); ++end) {
    const std::int64_t back_ns = events[end - 1].time_ns - events[end].time_ns;
    if (back_ns <= 0) continue;
    if (back_ns > kLargestSorted_ns) break;
    ++disordered_;
    largest_ns_ = std::max(largest_ns_, back_ns);
  }
  if (disordered_ != before) {
    std::stable_sort(events.begin(), events.begin() + static_cast<std::ptrdiff_t>(end),
                     [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; });
  }
  return end;
}

void EventOrder::split(std::vector<Event>& events, std::vector<Event>& rest) {
  const auto step = events.begin() + static_cast<std::ptrdiff_t>(arrange(events));
  rest.assign(step, events.end());
  events.erase(step, events.end());
}

std::string EventOrder::text() const {
  return fmt::format("Time runs backwards {} within packets, by {:.3f} ms at most; sorted.",
                     counted(disordered_, "time"), 1e-6 * static_cast<double>(largest_ns_));
}

}  // namespace evical
