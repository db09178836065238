#include "core/recording/text/table_header.h"

#include "core/base/how_to.h"
#include "core/base/nearest_name.h"
#include "core/base/time.h"
#include "core/base/trimmed.h"
#include "core/numerics/robust.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

namespace evical {
namespace {

constexpr std::string_view kAroundName = " \t\r\"'";
constexpr std::string_view kUnusedName = "-";
constexpr std::size_t kMostListed = 8;
constexpr std::size_t kFewestForRate = 10;
constexpr double kSlowestImu_hz = 20.0, kFastestImu_hz = 20'000.0;
constexpr double kSlowestPossible_hz = 2.0,
                 kFastestPossible_hz = 50'000.0;  // above, a stated unit is doubtful

using Axes = std::array<std::size_t, 3>;

std::vector<std::size_t> columnsOfKind(const TableHeader& header, ColumnKind kind) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < header.columns.size(); ++i)
    if (header.columns[i].kind == kind) found.push_back(i);
  return found;
}

// Columns of each complete group of three.
std::vector<Axes> vectorsOf(const TableHeader& header, ColumnKind kind) {
  std::map<std::string, std::vector<std::size_t>> groups;
  for (const std::size_t i : columnsOfKind(header, kind)) groups[header.columns[i].group].push_back(i);
  std::vector<Axes> vectors;
  for (const auto& [group, members] : groups) {
    const auto smallest = std::min_element(members.begin(), members.end(), [&](std::size_t a, std::size_t b) {
      return header.columns[a].axis < header.columns[b].axis;
    });
    const ColumnName& first = header.columns[*smallest];
    const int base = !first.lettered && first.axis == 1 ? 1 : 0;
    Axes axes{};
    std::array<int, 3> count{};
    for (const std::size_t i : members) {
      const int axis = header.columns[i].axis - base;
      if (axis < 0 || axis > 2) continue;
      axes[static_cast<std::size_t>(axis)] = i;
      ++count[static_cast<std::size_t>(axis)];
    }
    if (members.size() == 3 && count == std::array{1, 1, 1}) vectors.push_back(axes);
  }
  std::sort(vectors.begin(), vectors.end());
  return vectors;
}

// Header lines of any IMU; Kalibr's table is "timestamp, omega_x, ..., alpha_x, ...".
std::vector<Axes> accelerationsOf(const TableHeader& header) {
  const std::vector<Axes> named = vectorsOf(header, ColumnKind::Acceleration);
  return named.empty() && header.has(ColumnKind::AngularRate) ? vectorsOf(header, ColumnKind::Alpha) : named;
}

// Proposed line for the session; '?' for names without a known meaning.
std::string suggestion(const TableHeader& header) {
  std::string text;
  const auto add = [&](const std::string& name) { text += (text.empty() ? "" : ",") + name; };
  const std::vector<Axes> accelerations = accelerationsOf(header),
                          rates = vectorsOf(header, ColumnKind::AngularRate);
  // The first sensor is proposed if there are several.
  const auto isFurther = [](std::size_t i, const std::vector<Axes>& vectors) {
    return std::any_of(vectors.begin(), vectors.end(), [&](const Axes& axes) {
      return axes != vectors.front() && std::find(axes.begin(), axes.end(), i) != axes.end();
    });
  };
  for (std::size_t i = 0; i < header.columns.size(); ++i) {
    const ColumnName& column = header.columns[i];
    if (isFurther(i, accelerations) || isFurther(i, rates)) {
      add(std::string(kUnusedName));
      continue;
    }
    const std::string unit = column.unit.empty() ? "" : "_" + column.unit;
    switch (column.kind) {
      case ColumnKind::Time:
        add(timeUnitNamed(column.unit) ? "t" + unit : "t");
        break;
      case ColumnKind::Acceleration:
      case ColumnKind::AngularRate:
        add(fmt::format("{}{}{}", column.kind == ColumnKind::Acceleration ? 'a' : 'g',
                        column.lettered ? "xyz"[column.axis] : '?', unit));
        break;
      case ColumnKind::X:
        add("x");
        break;
      case ColumnKind::Y:
        add("y");
        break;
      case ColumnKind::Polarity:
        add("p");
        break;
      case ColumnKind::EventType:
        add("type");
        break;
      case ColumnKind::Point:
        add("point");
        break;
      default:
        add("?");
    }
  }
  return text;
}

void refuse(const TableHeader& header, std::string problem, TextColumns& columns) {
  columns.type = StreamType::Other;
  columns.problem = std::move(problem);
  columns.advice = columnsAdvice(suggestion(header));
}

// Suitability of a group of columns as the time; more is better.
int timeRank(const std::vector<std::size_t>& members, const TableHeader& header) {
  const std::string& group = header.columns[members.front()].group;
  const bool stamp = group.find("header_stamp") != std::string::npos;
  const bool late = group.find("log") != std::string::npos || group.find("receive") != std::string::npos ||
                    group.find("host") != std::string::npos || group.find("arrival") != std::string::npos;
  return (stamp ? 4 : 0) + (members.size() > 1 ? 2 : 0) - (late ? 1 : 0);
}

std::optional<std::int64_t> unitOfTime(const ColumnName& column) {
  return timeUnitNamed(column.unit);
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

// Chooses the columns whose sum is the time.
void chooseTime(const TableHeader& header, std::span<const TableColumn> table, TextColumns& columns) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<std::size_t>> groups;
  for (const std::size_t i : columnsOfKind(header, ColumnKind::Time)) {
    const std::string& group = header.columns[i].group;
    if (!groups.contains(group)) order.push_back(group);
    groups[group].push_back(i);
  }
  for (auto& [group, members] : groups) {
    std::stable_sort(members.begin(), members.end(), [&](std::size_t a, std::size_t b) {
      return unitOfTime(header.columns[a]).value_or(0) > unitOfTime(header.columns[b]).value_or(0);
    });
    if (members.size() > 1 && !areParts(members, header, table)) members = {members.front()};
  }
  const std::string best = *std::max_element(order.begin(), order.end(), [&](const auto& a, const auto& b) {
    return timeRank(groups[a], header) < timeRank(groups[b], header);
  });
  columns.time.clear();
  for (const std::size_t i : groups[best])
    columns.time.push_back({i, unitOfTime(header.columns[i]).value_or(0)});
  const bool doubtful = std::any_of(order.begin(), order.end(), [&](const std::string& group) {
    return group != best && timeRank(groups[group], header) == timeRank(groups[best], header);
  });
  if (doubtful)
    columns.notes.push_back(fmt::format("Several columns are times; {} is used. If this is wrong, {}.",
                                        header.names[groups[best].front()],
                                        "name the columns in the session (columns)"));
}

void chooseTimeUnit(std::span<const TableColumn> table, std::size_t rows, TextColumns& columns) {
  TimeColumn& time = columns.time.front();
  const bool known = time.column < table.size() && rows > 0;
  if (time.unit_ns != 0) {
    if (columns.type != StreamType::Imu || columns.time.size() > 1 || !known || rows < kFewestForRate) return;
    const std::int64_t likely_ns = guessUnit_ns(table[time.column], columns.type);
    const std::vector<double>& values = table[time.column].values;
    const double rate_hz =
        static_cast<double>(values.size() - 1) /
        (1e-9 * static_cast<double>(time.unit_ns) * std::max(values.back() - values.front(), 1e-9));
    const bool possible = rate_hz >= kSlowestPossible_hz && rate_hz <= kFastestPossible_hz;
    if (possible || likely_ns == time.unit_ns) return;
    columns.notes.push_back(
        fmt::format("The header states times in {}, which gives {:.4g} samples a second; {} would "
                    "give {:.4g}. Check the header, or name the columns in the session (columns).",
                    timeUnitName(time.unit_ns), rate_hz, timeUnitName(likely_ns),
                    rate_hz * static_cast<double>(time.unit_ns) / static_cast<double>(likely_ns)));
    return;
  }
  time.unit_ns = known ? guessUnit_ns(table[time.column], columns.type) : kSecond_ns;
  const bool obvious =
      known && (time.unit_ns == kSecond_ns ? !table[time.column].numbers.whole
                                           : table[time.column].numbers.largest >= kEpoch_ns);
  if (!obvious)
    columns.notes.push_back(fmt::format("The header does not state the unit of time; {} is assumed.",
                                        timeUnitName(time.unit_ns)));
}

// False, with the reason, if the three columns have no known unit, or different ones.
template <class Unit, class Read>
bool takeUnit(const TableHeader& header, const Axes& axes, Read read, const char* sensor, Unit& unit,
              double& factor, TextColumns& columns) {
  const std::string& first = header.columns[axes[0]].unit;
  for (const std::size_t i : axes) {
    const std::string& own = header.columns[i].unit;
    if (own == first) continue;
    refuse(header,
           fmt::format("its header gives the {}'s axes different units: {} and {}", sensor, first, own),
           columns);
    return false;
  }
  if (first.empty()) return true;
  const auto known = read(first);
  if (!known) {
    refuse(header, fmt::format("its header has an unknown unit of the {}: {}", sensor, first), columns);
    return false;
  }
  unit = known->unit;
  factor = known->factor;
  return true;
}

void applyImu(const TableHeader& header, TextColumns& columns) {
  const std::vector<Axes> accelerations = accelerationsOf(header),
                          rates = vectorsOf(header, ColumnKind::AngularRate);
  for (const auto& [vectors, sensor] :
       {std::pair{&accelerations, "accelerometer"}, std::pair{&rates, "gyroscope"}}) {
    if (vectors->empty())
      return refuse(header,
                    fmt::format("its header does not name three columns x, y and z of the {}", sensor),
                    columns);
    if (vectors->size() == 1) continue;
    std::vector<std::string> names;
    for (const Axes& axes : *vectors) names.push_back(header.names[axes[0]]);
    return refuse(header, fmt::format("its header names more than one {}: {}", sensor, joined(names)),
                  columns);
  }
  columns.type = StreamType::Imu;
  columns.acceleration = accelerations.front();
  columns.rate = rates.front();
  if (takeUnit(header, columns.acceleration, accelerationUnitOf, "accelerometer", columns.acceleration_unit,
               columns.acceleration_factor, columns))
    takeUnit(header, columns.rate, angularRateUnitOf, "gyroscope", columns.angular_rate_unit,
             columns.rate_factor, columns);
}

void applyEventsOrPoints(const TableHeader& header, TextColumns& columns) {
  const auto only = [&](ColumnKind kind, std::size_t& column) {
    const std::vector<std::size_t> found = columnsOfKind(header, kind);
    if (!found.empty()) column = found.front();
    if (found.size() > 1)
      refuse(header,
             fmt::format("its header has two columns with the same meaning: {} and {}",
                         header.names[found[0]], header.names[found[1]]),
             columns);
  };
  const bool events = header.has(ColumnKind::Polarity) || header.has(ColumnKind::EventType);
  columns.type = events ? StreamType::Events : StreamType::Points;
  columns.has_types = events && !header.has(ColumnKind::Polarity);
  only(ColumnKind::X, columns.x);
  only(ColumnKind::Y, columns.y);
  if (events) return only(columns.has_types ? ColumnKind::EventType : ColumnKind::Polarity, columns.polarity);
  only(ColumnKind::Point, columns.point);
  if (const auto sigma = columnsOfKind(header, ColumnKind::Sigma); !sigma.empty())
    columns.sigma = sigma.front();
}

std::string firstOf(const std::vector<std::string>& names) {
  const std::span<const std::string> all(names), first = all.first(std::min(all.size(), kMostListed));
  return joined(first) +
         (first.size() < all.size() ? fmt::format(" and {} more", all.size() - first.size()) : "");
}

bool namesImu(const TableHeader& header) {
  return header.has(ColumnKind::AngularRate) || header.has(ColumnKind::Acceleration);
}
bool namesPlaces(const TableHeader& header) {
  return header.has(ColumnKind::X) && header.has(ColumnKind::Y);
}
bool lacksTimes(const TableHeader& header) {
  return !header.has(ColumnKind::Time) && (namesImu(header) || namesPlaces(header));
}

std::string whatIsMissing(const TableHeader& header) {
  const bool imu = namesImu(header), places = namesPlaces(header);
  if (lacksTimes(header))
    return "its header names no column of times, and samples without times cannot be calibrated";
  if (imu)
    return fmt::format("its header names no {}",
                       header.has(ColumnKind::AngularRate) ? "accelerometer" : "gyroscope");
  if (places)
    return "its header names columns x and y, but neither polarity (events) nor point (measured points)";
  return fmt::format("its header names neither events, IMU samples nor measured points: {}",
                     firstOf(header.names));
}

std::string unusedNames(const TableHeader& header, const TextColumns& columns) {
  std::vector<std::size_t> used;
  for (const TimeColumn& part : columns.time) used.push_back(part.column);
  if (columns.type == StreamType::Imu) {
    used.insert(used.end(), columns.acceleration.begin(), columns.acceleration.end());
    used.insert(used.end(), columns.rate.begin(), columns.rate.end());
  } else {
    used.insert(used.end(), {columns.x, columns.y});
    used.push_back(columns.type == StreamType::Events ? columns.polarity : columns.point);
    if (columns.sigma) used.push_back(*columns.sigma);
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < header.names.size(); ++i)
    if (std::find(used.begin(), used.end(), i) == used.end() && header.names[i] != kUnusedName)
      names.push_back(header.names[i]);
  return names.empty() ? "" : firstOf(names);
}

}  // namespace

bool TableHeader::has(ColumnKind kind) const {
  return std::any_of(columns.begin(), columns.end(),
                     [&](const ColumnName& column) { return column.kind == kind; });
}

bool TableHeader::namesTable() const {
  if (!has(ColumnKind::Time)) return false;
  const bool imu = has(ColumnKind::AngularRate) && (has(ColumnKind::Acceleration) || has(ColumnKind::Alpha));
  const bool place = has(ColumnKind::X) && has(ColumnKind::Y);
  return imu ||
         (place && (has(ColumnKind::Polarity) || has(ColumnKind::EventType) || has(ColumnKind::Point)));
}

std::size_t TableHeader::recognised() const {
  return static_cast<std::size_t>(std::count_if(columns.begin(), columns.end(), [](const ColumnName& column) {
    return column.kind != ColumnKind::Other;
  }));
}

TableHeader readTableHeader(std::string_view line, bool comment) {
  std::string text(trimmed(line, kAroundName));
  while (comment && !text.empty() && (text[0] == '#' || text[0] == '%' || text[0] == '/' || text[0] == ' '))
    text.erase(0, 1);
  // A unit belongs to the preceding name, also if blanks separate names.
  for (const char bracket : {'[', '('})
    for (std::size_t at = text.find(bracket); at != std::string::npos; at = text.find(bracket, at + 1))
      while (at > 0 && text[at - 1] == ' ') text.erase(--at, 1);
  TableHeader header;
  header.comment = comment;
  std::vector<std::string_view> names;
  splitColumns(text, names);
  for (const std::string_view name : names) {
    header.names.emplace_back(trimmed(name, kAroundName));
    header.columns.push_back(name == kUnusedName ? ColumnName{} : columnNamed(header.names.back()));
  }
  return header;
}

void applyHeader(const TableHeader& header, std::span<const TableColumn> table, std::size_t rows,
                 TextColumns& columns) {
  if (rows > 0 && header.names.size() != table.size())
    return refuse(header,
                  fmt::format("its header has {} names, but its lines have {} columns", header.names.size(),
                              table.size()),
                  columns);
  if (!header.namesTable()) {
    refuse(header, whatIsMissing(header), columns);
    if (lacksTimes(header))
      columns.advice =
          "Add a column of times (t_s, t_ms, t_us or t_ns), preferably the sensor's. Row numbers divided by "
          "the rate of samples are only valid without missing rows";
    return;
  }
  if (header.has(ColumnKind::AngularRate)) {
    applyImu(header, columns);
  } else {
    applyEventsOrPoints(header, columns);
  }
  if (!columns.problem.empty()) return;
  chooseTime(header, table, columns);
  chooseTimeUnit(table, rows, columns);
  columns.unused = unusedNames(header, columns);
}

std::string columnsAdvice(const std::string& names) {
  const bool open = names.find('?') != std::string::npos;
  return fmt::format(
      "Name the columns {}, with the sensor: columns: \"{}\"{}; or put such a line at the top of the "
      "file",
      howTo(HowTo::EditSession), names,
      open ? " (for each ? one of t_s, t_ms, t_us, t_ns, ax, ay, az, gx, gy, gz, x, y, p, or - if it is not "
             "used)"
           : "");
}

std::int64_t guessUnit_ns(const TableColumn& time, StreamType type) {
  const std::vector<double>& values = time.values;
  if (type != StreamType::Imu || values.size() < kFewestForRate)
    return guessTimeUnit_ns(time.numbers, values.size());
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

}  // namespace evical
