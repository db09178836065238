#include "core/recording/column_guess.h"

#include "core/recording/column_names.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace evical {
namespace {

constexpr double kFewestEventsPerS = 50.0, kMaxEventsPerS = 5e7;  // of a plausible file of events
constexpr std::size_t kEnoughRows = 100;

}  // namespace

void ColumnNumbers::add(double number, bool first_row) {
  if (first_row) first = number;
  decreases = decreases || (!first_row && number < last);
  last = number;
  largest = std::max(largest, number);
  const bool is_whole = number == std::floor(number);
  whole = whole && is_whole;
  (is_whole && number >= 0.0 && number <= 65535.0 ? pixels : others) += 1;
  polarity = polarity && (number == 0.0 || number == 1.0 || number == -1.0);
}

std::optional<EventColumns> guessEventColumns(std::span<const ColumnNumbers> columns) {
  if (columns.size() != 4) return std::nullopt;
  EventColumns found;
  if (!columns[0].whole && columns[1].isPixel() && columns[2].isPixel() && columns[3].polarity)
    return found;  // the convention
  std::optional<std::size_t> time, polarity;
  for (std::size_t i = 0; i < 4; ++i) {
    if (columns[i].decreases) continue;
    const bool better =
        !time || (columns[*time].whole && !columns[i].whole) ||
        (columns[*time].whole == columns[i].whole && columns[i].largest > columns[*time].largest);
    if (better) time = i;
  }
  if (!time) return std::nullopt;
  for (std::size_t i = 0; i < 4; ++i)
    if (i != *time && columns[i].polarity) polarity = i;
  if (!polarity) return std::nullopt;
  std::vector<std::size_t> rest;
  for (std::size_t i = 0; i < 4; ++i)
    if (i != *time && i != *polarity && columns[i].isPixel()) rest.push_back(i);
  if (rest.size() != 2) return std::nullopt;
  found.time = *time;
  found.x = rest[0];
  found.y = rest[1];
  found.polarity = *polarity;
  return found;
}

std::int64_t guessTimeUnit_ns(const ColumnNumbers& time, std::size_t rows) {
  if (!time.whole) return 1'000'000'000;
  if (time.largest >= kEpoch_ns) return 1;
  const double span_s = 1e-6 * (time.last - time.first);
  const bool too_slow = rows >= kEnoughRows && static_cast<double>(rows) < kFewestEventsPerS * span_s;
  return too_slow ? 1 : 1000;
}

bool areOwnTimes_ns(const ColumnNumbers& time, std::size_t rows) {
  const double span_s = 1e-9 * (time.last - time.first);
  return time.whole && static_cast<double>(rows) <= kMaxEventsPerS * span_s;
}

const char* timeUnitName(std::int64_t unit_ns) {
  return unit_ns == 1 ? "ns" : unit_ns == 1000 ? "us" : unit_ns == 1'000'000 ? "ms" : "s";
}

std::optional<std::int64_t> timeUnitOf(std::string_view name) {
  while (!name.empty() && (name.back() == ']' || name.back() == ')' || name.back() == ' '))
    name.remove_suffix(1);
  const std::size_t before = name.find_last_of("[(_ ");
  return before == std::string_view::npos ? std::nullopt : timeUnitNamed(name.substr(before + 1));
}

}  // namespace evical
