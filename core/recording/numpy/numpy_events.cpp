#include "core/recording/numpy/numpy_events.h"

#include "core/base/time.h"
#include "core/recording/column_guess.h"

#include <cmath>
#include <limits>
#include <type_traits>

namespace evical::numpy {
namespace {

constexpr std::size_t kPacketRows = 32'768;

template <class Number>
bool toTime(Number time, std::int64_t unit_ns, std::int64_t offset_ns, std::int64_t& time_ns) {
  if constexpr (std::is_floating_point_v<Number>) {
    const double scaled_ns = time * static_cast<double>(unit_ns);
    if (!(std::abs(scaled_ns) <= static_cast<double>(kLatestTime_ns))) return false;
    const double whole = std::floor(time);  // separate from its fraction, so that no digit is lost
    time_ns = static_cast<std::int64_t>(whole) * unit_ns +
              std::llround((time - whole) * static_cast<double>(unit_ns));
  } else {
    if (__builtin_mul_overflow(time, unit_ns, &time_ns)) return false;
  }
  return !__builtin_add_overflow(time_ns, offset_ns, &time_ns) && isTime(time_ns);
}

template <class Number>
bool toPixel(Number number, std::uint16_t& pixel) {
  if (!(number >= 0) || number > static_cast<Number>(std::numeric_limits<std::uint16_t>::max())) return false;
  pixel = static_cast<std::uint16_t>(number);
  return static_cast<Number>(pixel) == number;
}

}  // namespace

EventTable::EventTable(const EventLayout& layout)
    : blocks_(layout.columns, layout.rows),
      rows_(layout.rows),
      unit_ns_(layout.unit_ns),
      offset_ns_(layout.offset_ns) {}

bool EventTable::load(std::vector<Event>& events) {
  const std::uint64_t first_row = blocks_.rowsRead();
  const std::size_t count = blocks_.next(kPacketRows);
  events.resize(count);
  if (count == 0) return false;
  bad_.assign(count, 0);
  loadTimes(first_row, events);
  loadPlaces(first_row, events);
  loadPolarities(first_row, events);
  std::size_t kept = 0;
  for (std::size_t row = 0; row < count; ++row)
    if (bad_[row] == 0) events[kept++] = events[row];
  events.resize(kept);
  return true;
}

void EventTable::loadTimes(std::uint64_t first_row, std::vector<Event>& events) {
  blocks_.forEach(2, [&](std::size_t row, auto number) {
    if (toTime(number, unit_ns_, offset_ns_, events[row].time_ns)) return;
    bad_[row] = 1;
    untimed_.add(first_row + row);
  });
}

void EventTable::loadPlaces(std::uint64_t first_row, std::vector<Event>& events) {
  const auto leaveOut = [&](std::size_t row) {
    if (bad_[row] == 0) outside_.add(first_row + row);
    bad_[row] = 1;
  };
  blocks_.forEach(0, [&](std::size_t row, auto number) {
    if (!toPixel(number, events[row].x_px)) leaveOut(row);
  });
  blocks_.forEach(1, [&](std::size_t row, auto number) {
    if (!toPixel(number, events[row].y_px)) leaveOut(row);
  });
}

void EventTable::loadPolarities(std::uint64_t first_row, std::vector<Event>& events) {
  blocks_.forEach(3, [&](std::size_t row, auto number) {
    const std::optional<bool> brighter = brighterOf(number);
    events[row].brighter = brighter.value_or(false);
    if (brighter) return;
    if (bad_[row] == 0) unpolarised_.add(first_row + row);
    bad_[row] = 1;
  });
}

}  // namespace evical::numpy
