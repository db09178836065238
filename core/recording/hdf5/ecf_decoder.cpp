#include "core/recording/hdf5/ecf_decoder.h"

#include "core/recording/byte_cursor.h"

#include <algorithm>
#include <array>

namespace evical::hdf5 {
namespace {

constexpr std::size_t kMostEvents = 65'535;

// `fill` is called with a run's length.
template <class Fill>
bool takeRun(ByteCursor& cursor, std::size_t& done, std::size_t total, std::size_t count, std::size_t escape,
             Fill&& fill) {
  if (count == escape) count = cursor.number<std::uint16_t>();
  if (!cursor.ok() || count > total - done) return false;
  for (std::size_t i = 0; i < count; ++i) fill(done++);
  return true;
}

bool decodeTimes(ByteCursor& cursor, std::vector<EcfEvent>& events) {
  auto time_us = static_cast<std::uint64_t>(cursor.number<std::int64_t>());
  for (std::size_t done = 0; done < events.size();) {
    auto byte = cursor.number<std::uint8_t>();
    std::uint64_t long_step = 0;
    int shift = 0;
    for (; cursor.ok() && byte >> 4 == 15; shift += 4, byte = cursor.number<std::uint8_t>()) {
      if (shift > 60) return false;
      long_step |= std::uint64_t{byte & 15U} << shift;
    }
    time_us += long_step + (byte >> 4);
    const auto fill = [&](std::size_t i) { events[i].t = static_cast<std::int64_t>(time_us); };
    if (!takeRun(cursor, done, events.size(), byte & 15U, 15, fill)) return false;
  }
  return cursor.ok();
}

// Four values of 24 bits in three words of 32, or of 12 bits in three words of 16.
template <class Word, class Store>
bool decodePacked(ByteCursor& cursor, std::size_t count, Store&& store) {
  constexpr unsigned kQuarter = sizeof(Word) * 2;  // bits of a value in the next word
  constexpr std::uint32_t kFull = sizeof(Word) == 4 ? 0xFFFFFFU : 0xFFFU;
  const auto low = [](std::uint32_t word, unsigned bits) { return word & ((1U << bits) - 1U); };
  for (std::size_t i = 0; i < count; i += 4) {
    const std::uint32_t a = cursor.number<Word>(), c = cursor.number<Word>(), d = cursor.number<Word>();
    if (!cursor.ok()) return false;
    const std::array<std::uint32_t, 4> values{
        a >> kQuarter, low(a, kQuarter) | (c >> 2 * kQuarter) << kQuarter,
        low(c, 2 * kQuarter) | (d >> 3 * kQuarter) << 2 * kQuarter, d & kFull};
    for (std::size_t k = 0; k < 4 && i + k < count; ++k) store(i + k, values[k]);
  }
  return true;
}

bool decodeRows(ByteCursor& cursor, std::vector<EcfEvent>& events) {
  for (std::size_t done = 0; done < events.size();) {
    const auto word = cursor.number<std::uint16_t>();
    const auto y = static_cast<std::uint16_t>(word >> 5);
    const auto fill = [&](std::size_t i) { events[i].y = y; };
    if (!takeRun(cursor, done, events.size(), word & 31U, 31, fill)) return false;
  }
  return true;
}

bool decodeColumns(ByteCursor& cursor, std::vector<EcfEvent>& events) {
  for (std::size_t done = 0; done < events.size();) {
    const auto word = cursor.number<std::uint16_t>();
    if (!cursor.ok()) return false;
    const unsigned x = word >> 5;
    events[done++].x = static_cast<std::uint16_t>(x);
    for (unsigned step = 1; step <= 5; ++step) {
      if ((word >> (5 - step) & 1U) == 0) continue;
      if (done == events.size()) return false;
      events[done++].x = static_cast<std::uint16_t>(x + step);
    }
  }
  return true;
}

bool decodePolarities(ByteCursor& cursor, std::vector<EcfEvent>& events) {
  for (std::size_t done = 0; done < events.size();) {
    const auto byte = cursor.number<std::uint8_t>();
    const auto fill = [&](std::size_t i) { events[i].p = static_cast<std::int16_t>(byte >> 7); };
    if (!takeRun(cursor, done, events.size(), byte & 127U, 127, fill)) return false;
  }
  return true;
}

}  // namespace

// Runs of length 0 make no progress, but each consumes bytes: every loop ends.
bool decodeEcf(std::string_view bytes, std::vector<EcfEvent>& events) {
  ByteCursor cursor(bytes);
  const auto header = cursor.number<std::uint32_t>();
  const std::size_t count = header >> 2;
  events.clear();
  if (!cursor.ok() || count > kMostEvents) return false;
  events.resize(count);
  if (!decodeTimes(cursor, events)) return false;
  if ((header & 2U) != 0) {
    return decodePacked<std::uint32_t>(cursor, count, [&](std::size_t i, std::uint32_t value) {
      events[i].y = static_cast<std::uint16_t>(value >> 12 & 0x7FFU);
      events[i].x = static_cast<std::uint16_t>(value >> 1 & 0x7FFU);
      events[i].p = static_cast<std::int16_t>(value & 1U);
    });
  }
  if (!decodeRows(cursor, events)) return false;
  if ((header & 1U) != 0) {
    return decodePacked<std::uint16_t>(cursor, count, [&](std::size_t i, std::uint32_t value) {
      events[i].x = static_cast<std::uint16_t>(value >> 1 & 0x7FFU);
      events[i].p = static_cast<std::int16_t>(value & 1U);
    });
  }
  return decodeColumns(cursor, events) && decodePolarities(cursor, events);
}

}  // namespace evical::hdf5
