#include "tests/support/packed_events.h"

#include <bit>

namespace evical::test {
namespace {

std::uint64_t microseconds(const Event& event) {
  return static_cast<std::uint64_t>(event.time_ns / 1000);
}

// Events from `first` on that fit into a vector of `width` pixels: same time, row and polarity, increasing x.
std::size_t endOfVector(EventSpan events, std::size_t first, unsigned width) {
  std::size_t end = first + 1;
  while (end < events.size() && events[end].time_ns / 1000 == events[first].time_ns / 1000 &&
         events[end].y_px == events[first].y_px && events[end].brighter == events[first].brighter &&
         events[end].x_px > events[end - 1].x_px &&
         events[end].x_px - events[first].x_px < static_cast<int>(width))
    ++end;
  return end;
}

std::uint32_t maskOf(EventSpan vector) {
  std::uint32_t mask = 0;
  for (const Event& event : vector) mask |= 1U << (event.x_px - vector.front().x_px);
  return mask;
}

}  // namespace

std::string encodeEvt2(EventSpan events) {
  std::string bytes;
  std::uint64_t high = ~std::uint64_t{0};
  for (const Event& event : events) {
    const std::uint64_t time_us = microseconds(event);
    if (time_us >> 6 != high) {
      high = time_us >> 6;
      appendWord(bytes, static_cast<std::uint32_t>(0x80000000U | (high & 0xFFFFFFF)));
    }
    appendWord(bytes, static_cast<std::uint32_t>((event.brighter ? 1U << 28 : 0U) | (time_us & 0x3F) << 22 |
                                                 static_cast<unsigned>(event.x_px) << 11 | event.y_px));
  }
  return bytes;
}

std::string encodeEvt21(EventSpan events, bool halves_exchanged) {
  std::string bytes;
  std::uint64_t high = ~std::uint64_t{0};
  const auto append = [&](std::uint64_t word) {
    appendWord(bytes, halves_exchanged ? std::rotl(word, 32) : word);
  };
  for (std::size_t i = 0; i < events.size();) {
    const std::uint64_t time_us = microseconds(events[i]);
    if (time_us >> 6 != high) {
      high = time_us >> 6;
      append(std::uint64_t{8} << 60 | (high & 0xFFFFFFF) << 32);
    }
    const std::size_t end = endOfVector(events, i, 32);
    append((events[i].brighter ? std::uint64_t{1} << 60 : 0) | (time_us & 0x3F) << 54 |
           std::uint64_t{events[i].x_px} << 43 | std::uint64_t{events[i].y_px} << 32 |
           maskOf(events.subspan(i, end - i)));
    i = end;
  }
  return bytes;
}

std::string encodeEvt3(EventSpan events) {
  std::string bytes;
  const auto append = [&bytes](unsigned code, std::uint64_t value) {
    appendWord(bytes, static_cast<std::uint16_t>(code << 12 | value));
  };
  std::uint64_t last_us = ~std::uint64_t{0};
  int row = -1;
  for (std::size_t i = 0; i < events.size();) {
    const Event& event = events[i];
    const std::uint64_t time_us = microseconds(event);
    if (time_us >> 12 != last_us >> 12) append(0x8, (time_us >> 12) & 0xFFF);
    if (time_us != last_us) append(0x6, time_us & 0xFFF);
    last_us = time_us;
    if (event.y_px != row) append(0x0, event.y_px);
    row = event.y_px;
    const std::size_t end = endOfVector(events, i, 12);
    const std::uint64_t place = std::uint64_t{event.x_px} | (event.brighter ? 0x800U : 0U);
    if (end == i + 1) {
      append(0x2, place);
    } else {
      append(0x3, place);
      append(0x4, maskOf(events.subspan(i, end - i)));
    }
    i = end;
  }
  return bytes;
}

std::string encodeDat(EventSpan events) {
  std::string bytes("\x0C\x08", 2);
  for (const Event& event : events) {
    appendWord(bytes, static_cast<std::uint32_t>(microseconds(event)));
    appendWord(bytes, static_cast<std::uint32_t>(event.x_px | static_cast<unsigned>(event.y_px) << 14 |
                                                 (event.brighter ? 1U << 28 : 0U)));
  }
  return bytes;
}

std::string encodeEventStream(EventSpan events, int height_px, bool atis) {
  std::string bytes;
  std::uint64_t last_us = 0;
  const std::uint64_t overflow_us = atis ? 63 : 127;
  for (const Event& event : events) {
    std::uint64_t step_us = microseconds(event) - last_us;
    last_us += step_us;
    for (; step_us >= overflow_us; step_us -= overflow_us)
      bytes.push_back(static_cast<char>(atis ? 0xFD : 0xFF));
    const unsigned polarity = event.brighter ? 1 : 0;
    bytes.push_back(static_cast<char>(atis ? step_us << 2 | polarity << 1 : step_us << 1 | polarity));
    appendWord(bytes, event.x_px);
    appendWord(bytes, static_cast<std::uint16_t>(height_px - 1 - event.y_px));
  }
  return bytes;
}

std::string eventStreamHeader(int width_px, int height_px, bool atis) {
  std::string bytes("Event Stream\x02\x00\x00", 15);
  bytes.push_back(atis ? 2 : 1);
  appendWord(bytes, static_cast<std::uint16_t>(width_px));
  appendWord(bytes, static_cast<std::uint16_t>(height_px));
  return bytes;
}

}  // namespace evical::test
