// Brings the events of one stream into the order that packets promise, and remembers what it had to do.
#pragma once

#include "core/data/event.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace evical {

class EventOrder {
 public:
  // How many of the first events make a packet: they are sorted where time steps back a little; before a
  // large step back the packet ends, since sorting would only hide it.
  std::size_t arrange(std::span<Event> events);

  bool changedAnything() const { return disordered_ > 0; }
  std::string text() const;  // one sentence for people

 private:
  std::uint64_t disordered_ = 0;
  std::int64_t largest_ns_ = 0;
};

}  // namespace evical
