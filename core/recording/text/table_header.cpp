#include "core/recording/text/table_header.h"

#include "core/base/how_to.h"
#include "core/base/nearest_name.h"
#include "core/base/plain_text.h"
#include "core/recording/text/table_axes.h"
#include "core/recording/text/table_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <tuple>

namespace evical {
namespace {

constexpr std::string_view kAroundName = " \t\r\"'";
constexpr std::string_view kUnusedName = "-";
// Advice for a proposed line whose units are dropped.
constexpr std::string_view kWithoutUnits =
    ". Axes without a unit are in m/s^2 or rad/s; state others, or the size of a raw count, in brackets: ax "
    "[0.001 g]";
constexpr std::size_t kMaxListed = 8;
constexpr std::size_t kMaxProposed = 100;
constexpr std::size_t kMaxImus = 8;

std::string firstOf(const std::vector<std::string>& names) {
  const std::span<const std::string> all(names), first = all.first(std::min(all.size(), kMaxListed));
  return joined(first) +
         (first.size() < all.size() ? fmt::format(" and {} more", all.size() - first.size()) : "");
}

bool namesImu(const TableHeader& header) {
  return header.has(ColumnKind::AngularRate) || header.has(ColumnKind::Acceleration);
}
bool namesPlaces(const TableHeader& header) {
  return header.has(ColumnKind::X) && header.has(ColumnKind::Y);
}

// Name that a column without a sensor's axis has in a proposed line; '?' without a known meaning.
std::string nameOfKind(ColumnKind kind) {
  switch (kind) {
    case ColumnKind::X:
      return "x";
    case ColumnKind::Y:
      return "y";
    case ColumnKind::Polarity:
      return "p";
    case ColumnKind::EventType:
      return "type";
    case ColumnKind::Point:
      return "point";
    default:
      return "?";
  }
}

// A sensor's unit in a proposed line, in brackets as headers have it; empty if it is not known.
std::string proposedUnit(const ColumnName& column) {
  const bool known = column.kind == ColumnKind::Acceleration ? accelerationUnitOf(column.unit).has_value()
                                                             : angularRateUnitOf(column.unit).has_value();
  return known ? " [" + column.unit + "]" : "";
}

std::string proposedTime(const std::string& unit) {
  const bool is_word = std::ranges::all_of(unit, [](unsigned char c) { return std::isalnum(c) != 0; });
  return !timeUnitNamed(unit) ? "t" : is_word ? "t_" + unit : "t [" + unit + "]";
}

// Name of a used column in a proposed line. `bare`: the letter of the sensor that bare axes belong to, if
// there are any.
std::string proposedName(const ColumnName& column, std::optional<char> bare, bool imu) {
  if (column.kind == ColumnKind::Time) return proposedTime(column.unit);
  if (column.kind == ColumnKind::Acceleration || column.kind == ColumnKind::AngularRate)
    return fmt::format("{}{}{}", column.kind == ColumnKind::Acceleration ? 'a' : 'g',
                       column.lettered ? "xyz"[column.axis] : '?', proposedUnit(column));
  if (bare && column.bare_axis >= 0) return fmt::format("{}{}", *bare, "xyz"[column.bare_axis]);
  return imu ? "?" : nameOfKind(column.kind);
}

// A line that names two columns alike would be refused, too. Several columns may be parts of one time.
void openTwins(const TableHeader& header, std::vector<std::string>& names) {
  const auto meaningOf = [](const std::string& name) { return name.substr(0, name.find(' ')); };
  std::map<std::string, std::size_t> counts;
  for (const std::string& name : names) ++counts[meaningOf(name)];
  for (std::size_t i = 0; i < names.size(); ++i)
    if (counts[meaningOf(names[i])] > 1 && header.columns[i].kind != ColumnKind::Time &&
        names[i] != kUnusedName)
      names[i] = "?";
}

// Removes the units of a sensor whose axes have different ones: such a line would be refused, too.
void dropMixedUnits(const std::vector<Axes>& vectors, TableHeader& header) {
  for (const Axes& axes : vectors)
    if (std::ranges::any_of(
            axes, [&](std::size_t i) { return header.columns[i].unit != header.columns[axes[0]].unit; }))
      for (const std::size_t i : axes) header.columns[i].unit.clear();
}

// Proposed line for the session; '?' for names without a known meaning. `sensor`: letter of a sensor for bare
// axes.
std::string suggestion(TableHeader header, std::span<const TableColumn> table, char sensor = '?') {
  const std::vector<Axes> accelerations = accelerationsOf(header),
                          rates = vectorsOf(header, ColumnKind::AngularRate);
  dropMixedUnits(accelerations, header);
  dropMixedUnits(rates, header);
  // The first sensor is proposed if there are several.
  const auto isFurther = [](std::size_t i, const std::vector<Axes>& vectors) {
    return std::any_of(vectors.begin(), vectors.end(), [&](const Axes& axes) {
      return axes != vectors.front() && std::find(axes.begin(), axes.end(), i) != axes.end();
    });
  };
  const std::optional<char> bare = bareAxesOf(header) ? std::optional(sensor) : std::nullopt;
  const bool imu = namesImu(header) || bare;
  const std::vector<std::size_t> time = chooseTime(header, table).columns;
  const auto isUnused = [&](std::size_t i) {
    const ColumnName& column = header.columns[i];
    const bool is_time = column.kind == ColumnKind::Time;
    return isFurther(i, accelerations) || isFurther(i, rates) || (imu && column.other_quantity) ||
           (is_time && std::find(time.begin(), time.end(), i) == time.end()) ||
           (bare && sensor != '?' && !is_time && column.bare_axis < 0);
  };
  std::vector<std::string> names;
  for (std::size_t i = 0; i < header.columns.size(); ++i)
    names.push_back(isUnused(i) ? std::string(kUnusedName) : proposedName(header.columns[i], bare, imu));
  openTwins(header, names);
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMaxProposed); ++i)
    text += (i > 0 ? "," : "") + names[i];
  return text + (names.size() > kMaxProposed ? fmt::format(",... ({} columns)", names.size()) : "");
}

// A header and the rows below it.
struct NamedTable {
  const TableHeader& header;
  std::span<const TableColumn> table;
};

void refuse(const NamedTable& named, std::string problem, TextColumns& columns) {
  const bool imu = namesImu(named.header) || bareAxesOf(named.header);
  columns.type = StreamType::Other;
  columns.problem = std::move(problem);
  columns.advice =
      columnsAdvice(suggestion(named.header, named.table), imu ? StreamType::Imu : StreamType::Other);
}

// False, with the reason, if the three columns have no known unit, or different ones.
template <class Unit, class Read>
bool takeUnit(const NamedTable& named, const Axes& axes, Read read, const char* sensor, Unit& unit,
              std::array<double, 3>& factor, TextColumns& columns) {
  const TableHeader& header = named.header;
  const std::string& first = header.columns[axes[0]].unit;
  for (const std::size_t i : axes) {
    const std::string& own = header.columns[i].unit;
    if (own == first) continue;
    refuse(named,
           fmt::format("its header gives the {}'s axes different units: {} and {}", sensor, first, own),
           columns);
    columns.advice += kWithoutUnits;
    return false;
  }
  if (first.empty()) return true;
  const auto known = read(first);
  if (!known) {
    refuse(named, fmt::format("its header has an unknown unit of the {}: {}", sensor, first), columns);
    columns.advice += kWithoutUnits;
    return false;
  }
  unit = known->unit;
  factor.fill(known->factor);
  return true;
}

// The sensors of one IMU in a table; one of the two may be missing.
struct NamedImu {
  std::string name;
  std::optional<Axes> acceleration, rate;
};

void applyImu(const NamedTable& named, const NamedImu& imu, TextColumns& columns) {
  columns.type = StreamType::Imu;
  columns.part = imu.name;
  columns.measured_by = !imu.rate           ? MeasuredBy::Accelerometer
                        : !imu.acceleration ? MeasuredBy::Gyroscope
                                            : MeasuredBy::Both;
  if (imu.acceleration) {
    columns.acceleration = *imu.acceleration;
    if (!takeUnit(named, columns.acceleration, accelerationUnitOf, "accelerometer", columns.acceleration_unit,
                  columns.acceleration_factor, columns))
      return;
  }
  if (!imu.rate) return;
  columns.rate = *imu.rate;
  takeUnit(named, columns.rate, angularRateUnitOf, "gyroscope", columns.angular_rate_unit,
           columns.rate_factor, columns);
}

// IMUs by the names of their columns: "imu0_ax", ..., "imu1_gz". Empty if the names do not pair the sensors.
std::vector<NamedImu> pairedImus(const TableHeader& header, const std::vector<Axes>& accelerations,
                                 const std::vector<Axes>& rates) {
  std::map<std::string, NamedImu> imus;
  const auto add = [&](const std::vector<Axes>& vectors, std::optional<Axes> NamedImu::*sensor) {
    return std::all_of(vectors.begin(), vectors.end(), [&](const Axes& axes) {
      const ColumnName& column = header.columns[axes[0]];
      NamedImu& imu = imus[column.imu];
      imu.name = column.imu;
      const bool first = !(imu.*sensor);
      imu.*sensor = axes;
      return first && !column.of_stage;
    });
  };
  if (!add(accelerations, &NamedImu::acceleration) || !add(rates, &NamedImu::rate)) return {};
  std::vector<NamedImu> found;
  for (const auto& [name, imu] : imus) {
    if (!imu.acceleration || !imu.rate || found.size() == kMaxImus) return {};
    found.push_back(imu);
  }
  return found;
}

// One sensor is enough if no other columns may be the other one.
bool mayLack(const NamedTable& named) {
  std::size_t unknown = 0;
  for (std::size_t i = 0; i < named.header.columns.size() && i < named.table.size(); ++i) {
    const ColumnName& column = named.header.columns[i];
    unknown += column.kind == ColumnKind::Other && !column.other_quantity && !column.numbers_imus &&
               !named.table[i].values.empty() && named.header.names[i] != kUnusedName;
  }
  return unknown < 3;
}

void applyImus(const NamedTable& named, TextColumns& columns) {
  const TableHeader& header = named.header;
  const std::vector<Axes> accelerations = accelerationsOf(header),
                          rates = vectorsOf(header, ColumnKind::AngularRate);
  const bool no_rate = !header.has(ColumnKind::AngularRate),
             no_force = !header.has(ColumnKind::Acceleration) && !header.has(ColumnKind::Alpha);
  if (accelerations.size() > 1 && rates.size() > 1) {
    const std::vector<NamedImu> imus = pairedImus(header, accelerations, rates);
    for (std::size_t k = 1; k < imus.size(); ++k) {
      applyImu(named, imus[k], columns.further.emplace_back());
      if (!columns.further.back().problem.empty()) columns = columns.further.back();
    }
    if (!columns.problem.empty()) return;
    if (!imus.empty()) return applyImu(named, imus.front(), columns);
  }
  for (const auto& [vectors, sensor, may_lack] :
       {std::tuple{&accelerations, "accelerometer", no_force}, std::tuple{&rates, "gyroscope", no_rate}}) {
    if (vectors->empty() && may_lack && mayLack(named)) continue;
    if (vectors->empty())
      return refuse(named,
                    may_lack
                        ? fmt::format("its header names no {}", sensor)
                        : fmt::format("its header does not name three columns x, y and z of the {}", sensor),
                    columns);
    if (vectors->size() == 1) continue;
    std::vector<std::string> names;
    for (const Axes& axes : *vectors) names.push_back(header.names[axes[0]]);
    return refuse(named, fmt::format("its header names more than one {}: {}", sensor, firstOf(names)),
                  columns);
  }
  const auto only = [](const std::vector<Axes>& vectors) {
    return vectors.empty() ? std::nullopt : std::optional(vectors.front());
  };
  applyImu(named, {"", only(accelerations), only(rates)}, columns);
}

// Texts of a column that occur about equally often: numbers of IMUs whose rows alternate. Empty for other
// columns.
std::vector<std::string> imuNumbers(const TableColumn& column) {
  std::map<std::string, std::size_t> counts;
  for (const std::string_view cell : column.cells) {
    ++counts[std::string(cell)];
    if (counts.size() > kMaxImus) return {};
  }
  std::vector<std::string> numbers;
  for (const auto& [text, count] : counts) {
    if (text.empty() || 4 * count * counts.size() < column.cells.size()) return {};
    numbers.push_back(text);
  }
  return numbers.size() > 1 && column.cells.size() >= 2 * numbers.size() ? numbers
                                                                         : std::vector<std::string>{};
}

// Rows of several IMUs, distinguished by a column with their numbers.
void separateRows(const NamedTable& named, TextColumns& columns) {
  for (std::size_t i = 0; i < named.header.columns.size() && i < named.table.size(); ++i) {
    if (!named.header.columns[i].numbers_imus || columns.only || !columns.further.empty()) continue;
    const std::vector<std::string> numbers = imuNumbers(named.table[i]);
    if (numbers.empty()) continue;
    const TextColumns all = columns;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      TextColumns& own = k == 0 ? columns : columns.further.emplace_back(all);
      own.only = RowSelection{i, numbers[k]};
      own.part = named.header.names[i] + " " + numbers[k];
    }
  }
}

void applyEventsOrPoints(const NamedTable& named, TextColumns& columns) {
  const TableHeader& header = named.header;
  const auto only = [&](ColumnKind kind, std::size_t& column) {
    const std::vector<std::size_t> found = columnsOfKind(header, kind);
    if (!found.empty()) column = found.front();
    if (found.size() > 1)
      refuse(named,
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
  if (bareAxesOf(header))
    return "its header names x, y and z, but neither polarity (events) nor point (measured points) nor the "
           "sensor of "
           "these axes";
  if (places)
    return "its header names columns x and y, but neither polarity (events) nor point (measured points)";
  return fmt::format("its header names neither events, IMU samples nor measured points: {}",
                     firstOf(header.names));
}

std::string unusedNames(const TableHeader& header, const TextColumns& columns) {
  std::vector<std::size_t> used;
  for (const TimeColumn& part : columns.time) used.push_back(part.column);
  if (columns.type == StreamType::Imu) {
    if (columns.measures(MeasuredBy::Accelerometer))
      used.insert(used.end(), columns.acceleration.begin(), columns.acceleration.end());
    if (columns.measures(MeasuredBy::Gyroscope))
      used.insert(used.end(), columns.rate.begin(), columns.rate.end());
    if (columns.only) used.push_back(columns.only->column);
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
  const bool both = has(ColumnKind::AngularRate) && (has(ColumnKind::Acceleration) || has(ColumnKind::Alpha));
  const bool imu = both || !vectorsOf(*this, ColumnKind::AngularRate).empty() ||
                   !vectorsOf(*this, ColumnKind::Acceleration).empty();
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

namespace {

// Time of each IMU, and what is not used.
void finishHeader(const NamedTable& named, TextColumns& columns) {
  const TimeChoice time = chooseTime(named.header, named.table, columns.part);
  columns.time.clear();
  for (const std::size_t i : time.columns)
    columns.time.push_back({i, timeUnitNamed(named.header.columns[i].unit).value_or(0)});
  if (time.doubtful)
    columns.notes.push_back(fmt::format("Several columns are times; {} is used. If this is wrong, {}.",
                                        named.header.names[time.columns.front()],
                                        "name the columns in the session (columns)"));
  chooseTimeUnit(named.table, columns);
  columns.unused = unusedNames(named.header, columns);
}

void refuseBareAxes(const NamedTable& named, TextColumns& columns) {
  columns.type = StreamType::Other;
  columns.problem = whatIsMissing(named.header);
  columns.advice = fmt::format(
      "If the table is of a gyroscope or an accelerometer, name it in the file's name, or name the columns "
      "{}, with the "
      "sensor: columns: \"{}\" or columns: \"{}\"; or put such a line at the top of the file",
      howTo(HowTo::EditSession), suggestion(named.header, named.table, 'g'),
      suggestion(named.header, named.table, 'a'));
}

}  // namespace

void applyHeader(TableHeader header, std::span<const TableColumn> table, std::size_t rows,
                 std::optional<MeasuredBy> sensor, TextColumns& columns) {
  nameBareAxes(sensor, header);
  const NamedTable named{header, table};
  if (rows > 0 && header.names.size() != table.size())
    return refuse(named,
                  fmt::format("its header has {} names, but its lines have {} columns", header.names.size(),
                              table.size()),
                  columns);
  if (!header.namesTable() && header.has(ColumnKind::Time) && bareAxesOf(header))
    return refuseBareAxes(named, columns);
  if (!header.namesTable() && !(header.has(ColumnKind::Time) && namesImu(header))) {
    refuse(named, whatIsMissing(header), columns);
    if (lacksTimes(header))
      columns.advice =
          "Add a column of times (t_s, t_ms, t_us or t_ns), preferably the sensor's. Row numbers divided by "
          "the rate of samples are only valid without missing rows";
    return;
  }
  if (namesImu(header)) {
    applyImus(named, columns);
    if (columns.problem.empty()) separateRows(named, columns);
  } else {
    applyEventsOrPoints(named, columns);
  }
  if (!columns.problem.empty()) {
    columns.further.clear();
    return;
  }
  finishHeader(named, columns);
  for (TextColumns& further : columns.further) finishHeader(named, further);
}

std::string columnsAdvice(const std::string& names, StreamType type) {
  const bool open = names.find('?') != std::string::npos, imu = type == StreamType::Imu;
  return fmt::format(
      "Name the columns {}, with the sensor: columns: \"{}\"{}; or put such a line at the top of the "
      "file",
      howTo(HowTo::EditSession), names,
      open ? fmt::format(" (for each ? one of t_s, t_ms, t_us, t_ns, ax, ay, az, gx, gy, gz{}, or - if it is "
                         "not used)",
                         imu ? "" : ", x, y, p")
           : "");
}

}  // namespace evical
