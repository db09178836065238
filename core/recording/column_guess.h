// Meaning of unnamed columns of numbers, and the unit of times, guessed from their first rows. For
// text tables and NumPy arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

namespace evical {

// One column in the first rows.
struct ColumnNumbers {
  double first = 0.0, last = 0.0, largest = std::numeric_limits<double>::lowest();
  bool whole = true, decreases = false, polarity = true;
  int pixels = 0, others = 0;  // numbers that can be coordinates, and others

  void add(double number, bool first_row);
  bool isPixel() const { return pixels > others; }  // a row may be bad
};

struct EventColumns {
  std::size_t time = 0, x = 1, y = 2, polarity = 3;
};

// The column that never decreases and exceeds the others is the time, one of two values the polarity; of the
// rest the order is x, y. nullopt if four columns cannot be events.
std::optional<EventColumns> guessEventColumns(std::span<const ColumnNumbers> columns);

// Whole times from here on are ns: as ns since 1970 this is 1973, as us the year 5138.
inline constexpr double kEpoch_ns = 1e17;

// Fractions are seconds; whole numbers us, or ns if us give an implausible time or event rate.
std::int64_t guessTimeUnit_ns(const ColumnNumbers& time, std::size_t rows);

// True if times of records that look like Evical's own (t, x, y and a bool p, from Python) are ns, as these
// are: whole, at a rate of events that a sensor can have.
bool areOwnTimes_ns(const ColumnNumbers& time, std::size_t rows);

// True for a brighter polarity: 1; false for 0 and -1. nullopt for others, which may be triggers.
template <class Number>
std::optional<bool> brighterOf(Number polarity) {
  if (polarity == Number(1)) return true;
  return polarity == Number(0) || polarity == static_cast<Number>(-1) ? std::optional(false) : std::nullopt;
}

const char* timeUnitName(std::int64_t unit_ns);  // "ns", "us", "ms" or "s"

// The unit at the end of "timestamp [ns]", "t_us", "time(s)".
std::optional<std::int64_t> timeUnitOf(std::string_view name);

}  // namespace evical
