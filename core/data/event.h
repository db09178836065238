// One event, without padding.
#pragma once

#include <cstdint>
#include <span>

namespace evical {

struct Event {
  std::int64_t time_ns;  // the recorder's clock, the file's own epoch
  std::uint16_t x_px, y_px;
  bool brighter;  // ON
};
static_assert(sizeof(Event) == 16);

using EventSpan = std::span<const Event>;

}  // namespace evical
