// Meaning of columns of numbers without names, and the unit of times: guessed from their first rows. For
// tables of text and arrays of NumPy.
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
  int pixels = 0, others = 0;  // whether the numbers can be coordinates

  void add(double number, bool first_row);
  bool isPixel() const { return pixels > others; }  // a row may be bad
};

struct EventColumns {
  std::size_t time = 0, x = 1, y = 2, polarity = 3;
};

// The column that never decreases and exceeds the others is the time, one of two values the polarity; of the
// rest the order is x, y. Nothing where four columns cannot be events.
std::optional<EventColumns> guessEventColumns(std::span<const ColumnNumbers> columns);

// Whole times from here on are ns: since 1970 it is 1973, and as us it would be the year 5138.
inline constexpr double kEpoch_ns = 1e17;

// Fractions are seconds; whole numbers us, or ns where us would be no time or no rate of events.
std::int64_t guessTimeUnit_ns(const ColumnNumbers& time, std::size_t rows);

// True for a brighter polarity: 1 is, 0 and -1 are not. Nothing for others, which may be triggers.
template <class Number>
std::optional<bool> brighterOf(Number polarity) {
  if (polarity == Number(1)) return true;
  return polarity == Number(0) || polarity == static_cast<Number>(-1) ? std::optional(false) : std::nullopt;
}

const char* timeUnitName(std::int64_t unit_ns);  // "ns", "us", "ms" or "s"

// The unit at the end of "timestamp [ns]", "t_us", "time(s)".
std::optional<std::int64_t> timeUnitOf(std::string_view name);

}  // namespace evical
