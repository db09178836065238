// Sorts the events of one stream into the order that packets guarantee, and counts the corrections.
#pragma once

#include "core/data/event.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace evical {

// Largest step back in time that readers sort.
inline constexpr std::int64_t kLargestSorted_ns = 10'000'000;

class EventOrder {
 public:
  // Keeps in `events` those of the next packet: they are sorted if time steps back a little; the packet ends
  // before a large step back, since sorting would hide it, and the events after it replace `rest`.
  void split(std::vector<Event>& events, std::vector<Event>& rest);

  bool changedAnything() const { return disordered_ > 0; }
  std::string text() const;  // one sentence for people

 private:
  std::size_t arrange(std::span<Event> events);  // number of first events in the packet

  std::uint64_t disordered_ = 0;
  std::int64_t largest_ns_ = 0;
};

}  // namespace evical
