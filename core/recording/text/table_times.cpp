#include "core/recording/text/table_times.h"

#include "core/base/time.h"
#include "core/numerics/robust.h"
#include "core/recording/text/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace evical {
namespace {

constexpr std::size_t kFewestForRate = 10;
constexpr double kSlowestImu_hz = 20.0, kFastestImu_hz = 20'000.0;
constexpr double kSlowestPossible_hz = 2.0,
                 kFastestPossible_hz = 50'000.0;  // above, a stated unit is doubtful

std::optional<std::int64_t> unitOfTime(const ColumnName& column) {
  return timeUnitNamed(column.unit);
}

// Suitability of a group of columns as the time of the samples of `imu`; more is better.
int timeRank(const std::vector<std::size_t>& members, const TableHeader& header, const std::string& imu) {
  const std::string& group = header.columns[members.front()].group;
  const auto contains = [&](const char* word) { return group.find(word) != std::string::npos; };
  const bool late = contains("log") || contains("receive") || contains("host") || contains("arrival") ||
                    contains("elapsed") || contains("relative") || contains("clock");
  const bool bare =
      group == "t" && header.columns[members.front()].unit.empty();  // also a temperature's name
  return (!imu.empty() && group.starts_with(imu) ? 8 : 0) + (contains("header_stamp") ? 4 : 0) +
         (members.size() > 1 ? 2 : 0) - (late || bare ? 1 : 0);
}

// Seconds and their fractions: each finer column is less than one unit of the next coarser one.
bool areParts(const std::vector<std::size_t>& members, const TableHeader& header,
              std::span<const TableColumn> table) {
  for (std::size_t k = 0; k < members.size(); ++k) {
    if (!unitOfTime(header.columns[members[k]]) || members[k] >= table.size()) return false;
    const ColumnNumbers& numbers = table[members[k]].numbers;
    if (k == 0) continue;
    const auto ratio = static_cast<double>(*unitOfTime(header.columns[members[k - 1]])) /
                       static_cast<double>(*unitOfTime(header.columns[members[k]]));
    if (ratio <= 1.0 || !numbers.whole || numbers.largest >= ratio) return false;
  }
  return true;
}

// A time of day or a date, whose numbers are in s.
bool isCalendar(const TableColumn& time) {
  std::int64_t ignored_ns = 0;
  return std::any_of(time.cells.begin(), time.cells.end(), [&](std::string_view cell) {
    return parseDate(cell, ignored_ns) || parseClock(cell, ignored_ns);
  });
}

bool isClock(const TableColumn& time) {
  std::int64_t ignored_ns = 0;
  return std::any_of(time.cells.begin(), time.cells.end(),
                     [&](std::string_view cell) { return parseClock(cell, ignored_ns); });
}

// The column of dates that belongs to times of day; absent if the table has none.
std::optional<std::size_t> dateColumn(std::span<const TableColumn> table) {
  constexpr std::size_t kDate = 10;
  const auto is_date = [](std::string_view cell) {
    std::int64_t ignored_ns = 0;
    return cell.size() == kDate && parseDate(cell, ignored_ns);
  };
  for (std::size_t i = 0; i < table.size(); ++i)
    if (!table[i].cells.empty() && std::ranges::all_of(table[i].cells, is_date)) return i;
  return std::nullopt;
}

// Events from Evical's Python module, written by pandas: their polarity is True or False.
bool isOwnTable(std::span<const TableColumn> table, const TextColumns& columns) {
  if (columns.type != StreamType::Events || columns.polarity >= table.size()) return false;
  const TableColumn& time = table[columns.time.front().column];
  return std::ranges::all_of(table[columns.polarity].cells,
                             [](std::string_view cell) { return cell == "True" || cell == "False"; }) &&
         areOwnTimes_ns(time.numbers, time.values.size());
}

void noteImpossibleRate(const TableColumn& time, std::int64_t unit_ns, TextColumns& columns) {
  const std::vector<double>& values = time.values;
  if (values.size() < kFewestForRate) return;
  const std::int64_t likely_ns = guessUnit_ns(time, columns.type);
  const double span = std::max(values.back() - values.front(), 1e-9);
  const double rate_hz =
      static_cast<double>(values.size() - 1) / (1e-9 * static_cast<double>(unit_ns) * span);
  const bool possible = rate_hz >= kSlowestPossible_hz && rate_hz <= kFastestPossible_hz;
  if (possible || likely_ns == unit_ns) return;
  columns.notes.push_back(
      fmt::format("The header states times in {}, which gives {:.4g} samples a second; {} would "
                  "give {:.4g}. Check the header, or name the columns in the session (columns).",
                  timeUnitName(unit_ns), rate_hz, timeUnitName(likely_ns),
                  rate_hz * static_cast<double>(unit_ns) / static_cast<double>(likely_ns)));
}

// Whole part and fraction of a cell without a sign; nullopt for other notations.
struct SplitTime {
  double whole = 0.0, fraction = 0.0;
  std::string_view digits;  // of the fraction
};
std::optional<SplitTime> splitTime(std::string_view cell) {
  SplitTime split;
  const std::size_t point = std::min(cell.find_first_of(".,"), cell.size());
  split.digits = point < cell.size() ? cell.substr(point + 1) : std::string_view();
  const auto plain = [](std::string_view text) {
    return text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  if (point == 0 || !plain(cell.substr(0, point)) || !plain(split.digits) || split.digits.size() > 9 ||
      !parseNumber(cell.substr(0, point), split.whole))
    return std::nullopt;
  if (!split.digits.empty()) parseNumber(split.digits, split.fraction);
  return split;
}

// Digits of fractions that are written without their leading zeros: as decimals these times would run
// backwards. 0 for decimals.
int digitsWithoutZeros(const TableColumn& time) {
  constexpr double kFarFewer = 0.1;
  std::vector<SplitTime> times;
  std::size_t longest = 0, shortest = 10;
  for (const std::string_view cell : time.cells) {
    const std::optional<SplitTime> split = splitTime(cell);
    if (!split) return 0;
    if (split->digits.size() > 1 && split->digits.front() == '0') return 0;
    longest = std::max(longest, split->digits.size());
    shortest = std::min(shortest, split->digits.size());
    times.push_back(*split);
  }
  if (longest <= shortest) return 0;
  const int digits = longest <= 3 ? 3 : longest <= 6 ? 6 : 9;
  std::size_t as_decimals = 0, as_parts = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const auto decimal = [](const SplitTime& t) {
      return t.whole + t.fraction * std::pow(10.0, -static_cast<double>(t.digits.size()));
    };
    const auto parts = [&](const SplitTime& t) { return t.whole + t.fraction * std::pow(10.0, -digits); };
    as_decimals += decimal(times[i]) < decimal(times[i - 1]) ? 1 : 0;
    as_parts += parts(times[i]) < parts(times[i - 1]) ? 1 : 0;
  }
  const bool parts =
      as_decimals > 0 && static_cast<double>(as_parts) <= kFarFewer * static_cast<double>(as_decimals);
  return parts ? digits : 0;
}

void checkEqual(const TableHead& head, TextColumns& columns) {
  const auto constant = [&](const TimeColumn& part) {
    const std::vector<double>& values = head.columns[part.column].values;
    return values.size() >= kFewestForRate &&
           std::all_of(values.begin(), values.end(), [&](double value) { return value == values.front(); });
  };
  if (!std::all_of(columns.time.begin(), columns.time.end(), constant)) return;
  const std::string_view cell = head.columns[columns.time.front().column].cells.front();
  const bool rounded = cell.find_first_of("eE") != std::string_view::npos;
  columns.type = StreamType::Other;
  columns.problem = fmt::format("all of the first {} samples have the same time, {}", head.rows, cell);
  columns.advice =
      rounded ? "A spreadsheet or a format such as %g rounded the times: export them again with all digits"
              : "Record again with the times of the samples, or name another column of times in the session "
                "(columns)";
}

}  // namespace

TimeChoice chooseTime(const TableHeader& header, std::span<const TableColumn> table, const std::string& imu) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < header.columns.size(); ++i) {
    if (header.columns[i].kind != ColumnKind::Time) continue;
    const std::string& group = header.columns[i].group;
    if (!groups.contains(group)) order.push_back(group);
    groups[group].push_back(i);
  }
  if (order.empty()) return {};
  for (auto& [group, members] : groups) {
    std::stable_sort(members.begin(), members.end(), [&](std::size_t a, std::size_t b) {
      return unitOfTime(header.columns[a]).value_or(0) > unitOfTime(header.columns[b]).value_or(0);
    });
    if (members.size() > 1 && !areParts(members, header, table)) members = {members.front()};
  }
  const auto rank = [&](const std::string& group) { return timeRank(groups[group], header, imu); };
  const std::string best = *std::max_element(order.begin(), order.end(),
                                             [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  const bool doubtful = std::any_of(order.begin(), order.end(), [&](const std::string& group) {
    return group != best && rank(group) == rank(best);
  });
  std::vector<std::size_t>& chosen = groups[best];
  if (chosen.size() == 1 && chosen.front() < table.size() && isClock(table[chosen.front()]))
    if (const std::optional<std::size_t> date = dateColumn(table)) chosen.insert(chosen.begin(), *date);
  return {chosen, doubtful};
}

std::int64_t guessUnit_ns(const TableColumn& time, StreamType type) {
  const std::vector<double>& values = time.values;
  if (type != StreamType::Imu || values.size() < kFewestForRate)
    return guessTimeUnit_ns(time.numbers, values.size());
  if (digitsWithoutZeros(time) > 0) return kSecond_ns;
  std::vector<double> steps;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] > values[i - 1]) steps.push_back(values[i] - values[i - 1]);
  if (steps.empty()) return guessTimeUnit_ns(time.numbers, values.size());
  const double step = medianOf(std::move(steps));
  for (const std::int64_t unit_ns : {std::int64_t{1}, kMicrosecond_ns, std::int64_t{1'000'000}, kSecond_ns}) {
    const double rate_hz = 1e9 / (step * static_cast<double>(unit_ns));
    if (rate_hz >= kSlowestImu_hz && rate_hz < kFastestImu_hz) return unit_ns;
  }
  return guessTimeUnit_ns(time.numbers, values.size());
}

void chooseTimeUnit(std::span<const TableColumn> table, TextColumns& columns) {
  TimeColumn& time = columns.time.front();
  const bool known = time.column < table.size() && !table[time.column].values.empty();
  if (known && isCalendar(table[time.column])) {
    time.unit_ns = kSecond_ns;
    return;
  }
  if (time.unit_ns != 0) {
    if (columns.type == StreamType::Imu && columns.time.size() == 1 && known)
      noteImpossibleRate(table[time.column], time.unit_ns, columns);
    return;
  }
  time.unit_ns = !known                       ? kSecond_ns
                 : isOwnTable(table, columns) ? 1
                                              : guessUnit_ns(table[time.column], columns.type);
  const bool obvious =
      known && (time.unit_ns == kSecond_ns ? !table[time.column].numbers.whole
                                           : table[time.column].numbers.largest >= kEpoch_ns);
  if (!obvious)
    columns.notes.push_back(fmt::format("The header does not state the unit of time; {} is assumed.",
                                        timeUnitName(time.unit_ns)));
}

void checkTimes(const TableHead& head, TextColumns& columns) {
  if (head.rows == 0 || columns.type == StreamType::Other) return;
  for (TimeColumn& part : columns.time) {
    const TableColumn& time = head.columns[part.column];
    columns.clock_times = columns.time.size() == 1 && isClock(time);  // not with a column of dates
    if (columns.time.size() > 1 || part.unit_ns != kSecond_ns) continue;
    part.fraction_digits = digitsWithoutZeros(time);
    if (part.fraction_digits == 0) continue;
    columns.notes.push_back(fmt::format(
        "Times such as {} are read as seconds and {} without leading zeros: as decimals they would run "
        "backwards.",
        *std::min_element(time.cells.begin(), time.cells.end(),
                          [](std::string_view a, std::string_view b) {
                            const auto digits = [](std::string_view cell) {
                              const std::size_t count = splitTime(cell)->digits.size();
                              return count > 1 ? count : 99;  // the zero has no other notation
                            };
                            return digits(a) < digits(b);
                          }),
        part.fraction_digits == 9   ? "nanoseconds"
        : part.fraction_digits == 6 ? "microseconds"
                                    : "milliseconds"));
  }
  if (columns.type == StreamType::Imu) checkEqual(head, columns);
}

}  // namespace evical
