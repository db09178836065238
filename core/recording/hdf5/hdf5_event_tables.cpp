#include "core/base/time.h"
#include "core/recording/column_guess.h"
#include "core/recording/hdf5/hdf5_filters.h"
#include "core/recording/hdf5/hdf5_tables.h"
#include "core/recording/plausible_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace evical::hdf5 {
namespace {

constexpr std::uint64_t kTablePacketRows = 32'768;
constexpr std::int64_t kEarliestNanoseconds = 100'000'000'000'000'000;  // us would be 3000 years
constexpr double kSecondsSpan_s = 1e6;                                  // no recording is 12 days long
constexpr std::size_t kHeadRows = 2000;                                 // that distinguish columns
constexpr std::uint16_t kOutside_px = 65'535;

std::uint16_t pixel(std::int32_t value) {
  return value >= 0 && value < kOutside_px ? static_cast<std::uint16_t>(value) : kOutside_px;
}

std::uint16_t pixel(double value) {
  return value >= 0.0 && value < kOutside_px ? static_cast<std::uint16_t>(value) : kOutside_px;
}

// `last` may be unreadable: then the format's default applies.
void chooseUnit(double first, double last, TimeScale& time) {
  if (time.is_real) {
    if (std::abs(last - first) > kSecondsSpan_s) time.factor_ns = 1000.0;
    time.unit_ns = 1;
  } else if (std::abs(first) > static_cast<double>(kEarliestNanoseconds)) {
    time.unit_ns = 1;
  }
}

// Another unit if the usual one gives a rate that no camera has. `seen` has the pixels.
std::string correctUnit(double first, double last, std::uint64_t rows, const SeenTimes& seen,
                        TimeScale& time) {
  constexpr std::array kUnits_ns = {1e9, 1e3, 1e6, 1.0};
  const auto nameOf = [](double unit_ns) { return timeUnitName(std::llround(unit_ns)); };
  const double usual_ns = time.is_real ? time.factor_ns : static_cast<double>(time.unit_ns);
  const auto isPlausible = [&](double unit_ns) {
    SeenTimes times = seen;
    times.add(0);
    times.add(std::llround(std::min(unit_ns * (last - first), 1e18)), rows - 1);
    return !whyImplausible(StreamType::Events, times);
  };
  if (rows < 2 || !(last > first) || isPlausible(usual_ns)) return {};
  // First units in which the recording is not very short.
  for (const double shortest_ns : {0.5e9, 0.0}) {
    for (const double unit_ns : kUnits_ns) {
      const bool other = unit_ns != usual_ns && (time.is_real || unit_ns <= 1e6);
      if (!other || unit_ns * (last - first) < shortest_ns || !isPlausible(unit_ns)) continue;
      time.factor_ns = unit_ns;
      if (!time.is_real) time.unit_ns = static_cast<std::int64_t>(unit_ns);
      return fmt::format("Times are read as {}: in {}, the usual unit, no event camera has this rate.",
                         nameOf(unit_ns), nameOf(usual_ns));
    }
  }
  return {};
}

class Columns : public EventTable {
 public:
  Columns(hid_t file, const std::array<DatasetInfo, 4>& columns, std::int64_t offset_us,
          const std::string& place, std::optional<std::int64_t> unit_ns)
      : x_(file, columns[0], H5T_NATIVE_INT32, place),
        y_(file, columns[1], H5T_NATIVE_INT32, place),
        p_(file, columns[3], H5T_NATIVE_INT8, place) {
    time_.is_real = columns[2].isReal();
    if (time_.is_real) {
      real_t_.emplace(file, columns[2], H5T_NATIVE_DOUBLE, place);
      rows_ = real_t_->rows();
    } else {
      whole_t_.emplace(file, columns[2], H5T_NATIVE_INT64, place);
      rows_ = whole_t_->rows();
    }
    const std::array<std::uint64_t, 4> lengths{x_.rows(), y_.rows(), rows_, p_.rows()};
    rows_ = *std::min_element(lengths.begin(), lengths.end());
    if (*std::max_element(lengths.begin(), lengths.end()) != rows_) {
      problem_ = fmt::format("x, y, t, p have {}, {}, {}, {} rows; the first {} are read", lengths[0],
                             lengths[1], lengths[2], lengths[3], rows_);
    }
    if (rows_ == 0) return;
    if (unit_ns) {
      time_.setUnit(*unit_ns);
      return;
    }
    const double first = timeOf(0), last = timeOf(rows_ - 1);
    chooseUnit(first, last, time_);
    time_.offset_ns = offset_us * 1000;
    SeenTimes seen;
    const auto xs = x_.numbersFrom(0), ys = y_.numbersFrom(0);
    for (std::size_t i = 0; i < std::min({xs.size(), ys.size(), kHeadRows}); ++i)
      seen.reach({0, pixel(xs[i]), pixel(ys[i]), false});
    note_ = correctUnit(first, last, rows_, seen, time_);
  }

  std::uint64_t rows() const override { return rows_; }

  std::uint64_t load(std::uint64_t row, std::vector<Event>& events) override {
    return time_.is_real ? loadWith(*real_t_, row, events) : loadWith(*whole_t_, row, events);
  }

 private:
  double timeOf(std::uint64_t row) {
    if (time_.is_real) {
      const auto values = real_t_->numbersFrom(row);
      return values.empty() ? 0.0 : values[0];
    }
    const auto values = whole_t_->numbersFrom(row);
    return values.empty() ? 0.0 : static_cast<double>(values[0]);
  }

  template <class Time>
  std::uint64_t loadWith(Rows<Time>& t, std::uint64_t row, std::vector<Event>& events) {
    for (DatasetRows* column : {static_cast<DatasetRows*>(&x_), static_cast<DatasetRows*>(&y_),
                                static_cast<DatasetRows*>(&t), static_cast<DatasetRows*>(&p_)}) {
      if (!column->from(row).empty()) continue;
      problem_ = column->problem();
      return std::min(rows_, column->blockEnd(row));
    }
    const auto xs = x_.numbersFrom(row), ys = y_.numbersFrom(row);
    const auto ts = t.numbersFrom(row);
    const auto ps = p_.numbersFrom(row);
    const auto count = static_cast<std::size_t>(
        std::min<std::uint64_t>({xs.size(), ys.size(), ts.size(), ps.size(), kTablePacketRows, rows_ - row}));
    const std::size_t begin = events.size();
    events.resize(begin + count);
    std::size_t used = begin, bad = 0, unpolarised = 0;
    for (std::size_t i = 0; i < count; ++i) {
      Event& event = events[used];
      if (!time_.convert(ts[i], event.time_ns)) {
        ++bad;
        continue;
      }
      const std::optional<bool> brighter = brighterOf(ps[i]);
      if (!brighter) {
        ++unpolarised;
        continue;
      }
      event.x_px = pixel(xs[i]);
      event.y_px = pixel(ys[i]);
      event.brighter = *brighter;
      ++used;
    }
    events.resize(used);
    if (bad > 0) problem_ = fmt::format("{} rows from {} on have no time", bad, row);
    if (unpolarised > 0) noteUnpolarised(unpolarised, row);
    return row + count;
  }

  Rows<std::int32_t> x_, y_;
  Rows<std::int8_t> p_;
  std::optional<Rows<std::int64_t>> whole_t_;
  std::optional<Rows<double>> real_t_;
  std::uint64_t rows_ = 0;
};

class EventRows : public EventTable {
 public:
  EventRows(hid_t file, const DatasetInfo& table, const std::string& place)
      : values_(file, table, H5T_NATIVE_DOUBLE, place) {
    time_.is_real = true;
    std::array<ColumnNumbers, 4> head;
    const std::size_t count = readHead(head);
    // Missing rows are reported by the reader.
    const auto last = count == 0 ? std::span<const double>() : values_.numbersFrom(rows() - 1);
    const bool is_empty = std::all_of(head.begin(), head.end(),
                                      [](const ColumnNumbers& column) { return column.largest <= 0.0; });
    if (last.empty() || is_empty) return;
    chooseColumns(head);
    const ColumnNumbers& times = head[columns_.time];
    if (times.whole)
      time_.factor_ns = static_cast<double>(guessTimeUnit_ns(times, count));
    else
      chooseUnit(times.first, last[columns_.time], time_);
  }

  std::uint64_t rows() const override { return values_.rows(); }

  std::uint64_t load(std::uint64_t row, std::vector<Event>& events) override {
    const auto values = values_.numbersFrom(row);
    if (values.empty()) {
      problem_ = values_.problem();
      return values_.blockEnd(row);
    }
    const std::size_t count = std::min<std::size_t>(values.size() / 4, kTablePacketRows);
    for (std::size_t i = 0; i < count; ++i) {
      Event event{};
      if (!time_.convert(values[4 * i + columns_.time], event.time_ns)) {
        problem_ = fmt::format("row {} has no time", row + i);
        continue;
      }
      const std::optional<bool> brighter = brighterOf(values[4 * i + columns_.polarity]);
      if (!brighter) {
        noteUnpolarised(1, row + i);
        continue;
      }
      event.x_px = pixel(values[4 * i + columns_.x]);
      event.y_px = pixel(values[4 * i + columns_.y]);
      event.brighter = *brighter;
      events.push_back(event);
    }
    return row + count;
  }

 private:
  std::size_t readHead(std::array<ColumnNumbers, 4>& head) {
    const auto first = values_.numbersFrom(0);
    const std::size_t count = std::min(first.size() / 4, kHeadRows);
    for (std::size_t i = 0; i < 4 * count; ++i) head[i % 4].add(first[i], i < 4);
    return count;
  }

  // MVSEC has x, y, t, p; v2e t, x, y, p.
  void chooseColumns(const std::array<ColumnNumbers, 4>& head) {
    const std::optional<EventColumns> found = guessEventColumns(head);
    if (!found)
      throw UnknownColumns("its four columns are not x, y, time and polarity of events in any order");
    columns_ = *found;
  }

  EventColumns columns_ = {2, 0, 1, 3};
  Rows<double> values_;
};

Handle compoundType() {
  Handle type(H5Tcreate(H5T_COMPOUND, sizeof(EcfEvent)), H5Tclose);
  H5Tinsert(type, "x", offsetof(EcfEvent, x), H5T_NATIVE_UINT16);
  H5Tinsert(type, "y", offsetof(EcfEvent, y), H5T_NATIVE_UINT16);
  H5Tinsert(type, "p", offsetof(EcfEvent, p), H5T_NATIVE_INT16);
  H5Tinsert(type, "t", offsetof(EcfEvent, t), H5T_NATIVE_INT64);
  return type;
}

class Compound : public EventTable {
 public:
  Compound(hid_t file, const DatasetInfo& list, const std::string& place)
      : values_(file, list, compoundType(), place) {}

  std::uint64_t rows() const override { return values_.rows(); }

  std::uint64_t load(std::uint64_t row, std::vector<Event>& events) override {
    const auto values = values_.numbersFrom(row);
    if (values.empty()) {
      problem_ = values_.problem();
      return values_.blockEnd(row);
    }
    const std::size_t count = std::min<std::size_t>(values.size(), kTablePacketRows);
    for (std::size_t i = 0; i < count; ++i) {
      const std::optional<bool> brighter = brighterOf(values[i].p);
      Event event{0, values[i].x, values[i].y, brighter.value_or(false)};
      if (!brighter) {
        noteUnpolarised(1, row + i);
      } else if (time_.convert(values[i].t, event.time_ns)) {
        events.push_back(event);
      } else {
        problem_ = fmt::format("row {} has no time: its chunk has fewer events than it should", row + i);
      }
    }
    return row + count;
  }

 private:
  Rows<EcfEvent> values_;
};

}  // namespace

void EventTable::noteUnpolarised(std::size_t count, std::uint64_t row) {
  problem_ = fmt::format("{} rows from {} on have a polarity other than 1, 0 and -1", count, row);
}

bool TimeScale::convert(std::int64_t time, std::int64_t& time_ns) const {
  std::int64_t scaled_ns = 0;
  return !__builtin_mul_overflow(time, unit_ns, &scaled_ns) &&
         !__builtin_add_overflow(scaled_ns, offset_ns, &time_ns) && isTime(time_ns);
}

bool TimeScale::convert(double time, std::int64_t& time_ns) const {
  const double scaled_ns = time * factor_ns;
  if (!(std::abs(scaled_ns) <= static_cast<double>(kLatestTime_ns))) return false;
  return !__builtin_add_overflow(std::llround(scaled_ns), offset_ns, &time_ns) && isTime(time_ns);
}

std::unique_ptr<EventTable> openColumns(hid_t file, const std::array<DatasetInfo, 4>& columns,
                                        std::int64_t offset_us, const std::string& place,
                                        std::optional<std::int64_t> unit_ns) {
  return std::make_unique<Columns>(file, columns, offset_us, place, unit_ns);
}

std::unique_ptr<EventTable> openEventRows(hid_t file, const DatasetInfo& table, const std::string& place) {
  return std::make_unique<EventRows>(file, table, place);
}

std::unique_ptr<EventTable> openCompound(hid_t file, const DatasetInfo& list, const std::string& place) {
  return std::make_unique<Compound>(file, list, place);
}

}  // namespace evical::hdf5
