// Brings the events of one stream into the order that packets promise, and remembers what it had to do.
#pragma once

#include "core/data/event.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace evical {

// Largest step back in time that readers sort away.
inline constexpr std::int64_t kLargestSorted_ns = 10'000'000;

class EventOrder {
 public:
  // Leaves in `events` those that make a packet: they are sorted where time steps back a little; before a large step back
  // the packet ends, since sorting would only hide it, and what is behind replaces `rest`.
  void split(std::vector<Event>& events, std::vector<Event>& rest);

  bool changedAnything() const { return disordered_ > 0; }
  std::string text() const;  // one sentence for people

 private:
  std::size_t arrange(std::span<Event> events);  // how many of the first make a packet

  std::uint64_t disordered_ = 0;
  std::int64_t largest_ns_ = 0;
};

}  // namespace evical
