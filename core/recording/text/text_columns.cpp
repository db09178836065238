#include "core/recording/text/text_columns.h"

#include "core/base/plain_text.h"
#include "core/base/time.h"
#include "core/numerics/robust.h"
#include "core/recording/column_guess.h"
#include "core/recording/text/table_times.h"
#include "core/recording/text/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

namespace evical {
namespace {

constexpr std::string_view kAroundCell = " \t\r\"'";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kMaxRows = 2000;
constexpr std::size_t kImuColumns = 7;
constexpr std::size_t kEchoedImuColumns = 40;  // of sensor_msgs/Imu: 2 of time, frame, 37 numbers

// Calls parse(text) with the decimal point in place of the comma.
template <class Parse>
bool withPoint(std::string_view text, Parse parse) {
  std::array<char, 64> copy{};
  if (text.size() > copy.size()) return false;
  std::replace_copy(text.begin(), text.end(), copy.begin(), ',', '.');
  return parse(std::string_view(copy.data(), text.size()));
}

bool isGravity(double norm) {
  return std::abs(norm - kStandardGravity_m_s2) < 0.8 || std::abs(norm - 1.0) < 0.08;
}

std::vector<ColumnNumbers> numbersOf(const TableHead& head) {
  std::vector<ColumnNumbers> numbers;
  for (const TableColumn& column : head.columns) numbers.push_back(column.numbers);
  return numbers;
}

// Coordinates with decimals are of undistorted or rectified events.
bool refuseDecimalPixels(const TableHead& head, TextColumns& columns) {
  std::vector<ColumnNumbers> numbers = numbersOf(head);
  for (ColumnNumbers& column : numbers)
    if (column.pixels == 0 && column.first >= 0.0 && column.largest <= 65535.0)
      std::swap(column.pixels, column.others);
  const std::optional<EventColumns> events = guessEventColumns(numbers);
  if (!events) return false;
  columns.problem = fmt::format(
      "no header names the columns; as events, line {} has the coordinates {} and {}, which are not whole "
      "pixels",
      head.lines.front(), head.columns[events->x].cells.front(), head.columns[events->y].cells.front());
  columns.advice =
      "Give the raw events of the sensor: undistorted or averaged coordinates cannot be calibrated";
  return true;
}

bool guessEvents(const TableHead& head, TextColumns& columns) {
  const std::optional<EventColumns> events = guessEventColumns(numbersOf(head));
  if (!events) return false;
  columns.type = StreamType::Events;
  columns.time = {{events->time, 0}};
  columns.x = events->x;
  columns.y = events->y;
  columns.polarity = events->polarity;
  return true;
}

// `ros2 topic echo --csv` of sensor_msgs/Imu: seconds, nanoseconds, frame, orientation and its covariance,
// rates and theirs, accelerations and theirs.
bool recogniseEcho(const TableHead& head, TextColumns& columns) {
  if (head.columns.size() != kEchoedImuColumns || head.columns[2].numbers.isPixel()) return false;
  const auto whole = [&](std::size_t i) {
    return head.columns[i].values.size() == head.rows && head.columns[i].numbers.whole;
  };
  if (!whole(0) || !whole(1) || head.columns[1].numbers.largest >= 1e9) return false;
  columns.type = StreamType::Imu;
  columns.time = {{0, kSecond_ns}, {1, 1}};
  columns.rate = {16, 17, 18};
  columns.acceleration = {28, 29, 30};
  return true;
}

// Seven columns: gravity identifies the accelerometer's three.
bool guessImu(const TableHead& head, TextColumns& columns) {
  if (head.columns.size() != kImuColumns) return false;
  const bool first = isGravity(medianOf(head.first_norms)), second = isGravity(medianOf(head.second_norms));
  if (first == second) {
    columns.problem =
        "no header names the columns, and the numbers do not show which ones are the accelerometer's";
    columns.advice = columnsAdvice("t_s,ax,ay,az,gx,gy,gz", StreamType::Imu);
    return false;
  }
  columns.type = StreamType::Imu;
  columns.time = {{0, 0}};
  columns.acceleration = first ? std::array<std::size_t, 3>{1, 2, 3} : std::array<std::size_t, 3>{4, 5, 6};
  columns.rate = first ? std::array<std::size_t, 3>{4, 5, 6} : std::array<std::size_t, 3>{1, 2, 3};
  return true;
}

void describeGuess(TextColumns& columns) {
  const char* unit = timeUnitName(columns.time.front().unit_ns);
  const bool events = columns.type == StreamType::Events;
  std::string order;
  const auto name = [&](std::size_t i) -> std::string {
    if (i == columns.time.front().column) return "t";
    if (events) return i == columns.x ? "x" : i == columns.y ? "y" : "p";
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (columns.acceleration[axis] == i) return fmt::format("a{}", "xyz"[axis]);
      if (columns.rate[axis] == i) return fmt::format("g{}", "xyz"[axis]);
    }
    return "-";
  };
  for (std::size_t i = 0; i < columns.count(); ++i) order += fmt::format("{}{}", i == 0 ? "" : ",", name(i));
  const bool conventional =
      (order == "t,x,y,p" || order == "t,ax,ay,az,gx,gy,gz") && columns.time.front().unit_ns == kSecond_ns;
  if (conventional) return;
  columns.notes.push_back(fmt::format(
      "There is no header; the columns are interpreted as {}, t in {}. If this is wrong, add a line "
      "such as \"t_{},{}\" at the top.",
      order, unit, unit, events ? "x,y,p" : "ax,ay,az,gx,gy,gz"));
}

// The line above the rows that names their columns; nullptr if absent.
const TableHeader* headerOf(const TableHead& head) {
  const auto fits = [&](const TableHeader& header) {
    return head.rows == 0 || header.names.size() == head.columns.size();
  };
  const TableHeader* best = nullptr;
  for (const TableHeader& header : head.headers) {  // the last of the best
    const auto rank = [&](const TableHeader& each) {
      return (each.namesTable() ? 4 : 0) + (fits(each) ? 2 : 0) + (each.comment ? 0 : 1);
    };
    if (!best || rank(header) >= rank(*best)) best = &header;
  }
  const bool is_header =
      best &&
      (best->namesTable() || (fits(*best) && head.rows > 0 && (!best->comment || best->recognised() >= 2)));
  return is_header ? best : nullptr;
}

// RPG's data set: events.txt is "t x y p", imu.txt "t ax ay az gx gy gz".
bool followConvention(const TableHead& head, StreamType convention, TextColumns& columns) {
  const bool events = convention == StreamType::Events && head.columns.size() >= 4;
  const bool imu = convention == StreamType::Imu && head.columns.size() >= kImuColumns;
  const bool rate_first =
      imu && isGravity(medianOf(head.second_norms)) && !isGravity(medianOf(head.first_norms));
  if (head.rows > 0 && ((!events && !imu) || rate_first)) return false;
  columns.type = convention;
  if (convention == StreamType::Other || head.rows == 0) return convention != StreamType::Other;
  std::int64_t& unit_ns = columns.time.front().unit_ns;
  unit_ns = guessUnit_ns(head.columns.front(), convention);
  if (unit_ns != kSecond_ns)
    columns.notes.push_back(fmt::format(
        "There is no header. Files of this name have times in s, but these fit {}, which is assumed. If "
        "this is wrong, add a line such as \"t_s,{}\" at the top.",
        timeUnitName(unit_ns), events ? "x,y,p" : "ax,ay,az,gx,gy,gz"));
  return true;
}

StreamType conventionOf(const std::string& file) {
  return file == "events.txt" ? StreamType::Events : file == "imu.txt" ? StreamType::Imu : StreamType::Other;
}

// Columns that a row must have as numbers, with the names for messages.
std::vector<std::pair<std::size_t, std::string>> neededColumns(const TextColumns& columns) {
  std::vector<std::pair<std::size_t, std::string>> needed;
  for (const TimeColumn& part : columns.time) needed.emplace_back(part.column, "time");
  if (columns.type == StreamType::Imu) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (columns.measures(MeasuredBy::Accelerometer))
        needed.emplace_back(columns.acceleration[axis], fmt::format("acceleration {}", "xyz"[axis]));
      if (columns.measures(MeasuredBy::Gyroscope))
        needed.emplace_back(columns.rate[axis], fmt::format("angular rate {}", "xyz"[axis]));
    }
    return needed;
  }
  needed.insert(needed.end(), {{columns.x, "x"}, {columns.y, "y"}});
  needed.emplace_back(columns.type == StreamType::Events ? columns.polarity : columns.point,
                      columns.type == StreamType::Events ? "polarity" : "point");
  return needed;
}

constexpr const char* kWithoutThousands =
    "Write times without thousands separators, such as 1700000000000000000";

// The first time with a point between thousands, if times as decimals would run backwards: 995, then 1.000.
// Shorter ones of the same column look like decimals.
std::optional<std::size_t> firstThousands(const TableColumn& time) {
  std::optional<std::size_t> first;
  bool several = false, back_as_decimals = false;
  double last = -1.0, last_decimal = -1.0;
  for (std::size_t row = 0; row < time.cells.size(); ++row) {
    std::string_view cell = time.cells[row];
    std::string joined;
    for (std::size_t group = 0; !cell.empty(); ++group) {
      const std::size_t point = std::min(cell.find('.'), cell.size());
      const std::string_view digits = cell.substr(0, point);
      if (digits.empty() || digits.size() > 3 || (group > 0 && digits.size() != 3) ||
          digits.find_first_not_of("0123456789") != std::string_view::npos)
        return std::nullopt;
      joined += digits;
      several = several || group > 1;
      if (group == 1 && !first) first = row;
      cell.remove_prefix(std::min(point + 1, cell.size()));
    }
    double number = 0.0, decimal = last_decimal;
    if (!parseNumber(joined, number) || number < last) return std::nullopt;
    parseNumber(time.cells[row], decimal);
    back_as_decimals = back_as_decimals || decimal < last_decimal;
    last = number;
    last_decimal = decimal;
  }
  return several || back_as_decimals ? first : std::nullopt;
}

void refuseCell(TextColumns& columns, std::uint64_t line, const std::string& what, std::string_view cell) {
  constexpr std::size_t kMaxShown = 40;
  const bool time = what == "time";
  const bool thousands = std::ranges::any_of(std::string_view(".,'_ "),
                                             [&](char mark) { return std::ranges::count(cell, mark) > 1; });
  columns.type = StreamType::Other;
  columns.problem = cell.empty()
                        ? fmt::format("line {} has no {}, nor have the lines below", line, what)
                        : fmt::format("line {} has \"{}\" as {}, and no line below has one that can be read",
                                      line, cell.substr(0, kMaxShown), what);
  columns.advice = !time       ? "Write numbers with a decimal point, or check the names of the columns"
                   : thousands ? kWithoutThousands
                               : "Write times as numbers, as 2026-03-01T10:00:00.25Z, or as 12:34:56.789";
}

// No row can be read if a column has no readable cell.
void checkReadable(const TableHead& head, TextColumns& columns) {
  if (columns.type == StreamType::Other || head.rows == 0) return;
  for (const auto& [column, what] : neededColumns(columns)) {
    if (column >= head.columns.size() || head.columns[column].values.empty())
      return refuseCell(columns, head.lines.front(), what,
                        column < head.columns.size() ? head.columns[column].cells.front() : "");
    const std::optional<std::size_t> row =
        what == "time" ? firstThousands(head.columns[column]) : std::nullopt;
    if (row) {
      columns.type = StreamType::Other;
      columns.problem =
          fmt::format("line {} has the time {}: its point separates thousands, and is not a decimal point",
                      head.lines[*row], head.columns[column].cells[*row]);
      columns.advice = kWithoutThousands;
      return;
    }
    const bool place = columns.type == StreamType::Events && (what == "x" || what == "y");
    if (!place || head.columns[column].numbers.pixels > 0) continue;
    refuseCell(columns, head.lines.front(), what, head.columns[column].cells.front());
    columns.advice =
        "Give the raw events of the sensor, in whole pixels: undistorted or averaged coordinates cannot be "
        "calibrated";
    return;
  }
}

// The header is that of a table, but no line below has numbers.
void checkUnread(const TableHead& head, TextColumns& columns) {
  if (columns.type == StreamType::Other || head.rows > 0 || head.unread_line == 0) return;
  if (head.unread_cells.size() < columns.count()) {
    columns.type = StreamType::Other;
    columns.problem = fmt::format("line {} has {} columns, but its header names {} that are needed",
                                  head.unread_line, head.unread_cells.size(), columns.count());
    columns.advice = "Check the lines of the table";
    return;
  }
  for (const auto& [column, what] : neededColumns(columns))
    if (!cellNumber(head.unread_cells[column], head.style))
      return refuseCell(columns, head.unread_line, what, head.unread_cells[column]);
}

// Reads the axes in the order that a line above the header states: "yxZ". An upper case letter is the
// channel, a lower case one its negative. Lower case letters only have signs if the axes are right-handed
// with them.
bool turnAxes(const std::string& orientation, TextColumns& columns) {
  std::array<std::size_t, 3> channel{};
  std::array<double, 3> sign{};
  bool lower = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto letter = static_cast<unsigned char>(orientation[i]);
    channel[i] = static_cast<std::size_t>(std::tolower(letter) - 'x');
    sign[i] = std::isupper(letter) != 0 ? 1.0 : -1.0;
    lower = lower && sign[i] < 0.0;
  }
  const bool even = (channel[1] + 3 - channel[0]) % 3 == 1;
  const bool right_handed = even == (sign[0] * sign[1] * sign[2] > 0.0);
  if (!right_handed && !(lower && even)) return false;
  if (!right_handed) sign = {1.0, 1.0, 1.0};
  const auto turn = [&](auto& values) {
    const auto before = values;
    for (std::size_t i = 0; i < 3; ++i) values[i] = before[channel[i]];
  };
  turn(columns.acceleration);
  turn(columns.acceleration_factor);
  turn(columns.rate);
  turn(columns.rate_factor);
  for (std::size_t i = 0; i < 3; ++i) {
    columns.acceleration_factor[i] *= sign[i];
    columns.rate_factor[i] *= sign[i];
  }
  return true;
}

// A scale that is not a possible one; false otherwise.
bool refuseScale(const char* name, double scale, TextColumns& columns) {
  constexpr double kLargest = 1e6;
  if (scale > 0.0 && scale < kLargest) return false;
  columns.type = StreamType::Other;
  columns.problem = fmt::format("the scale \"{} {:g}\" above its header is not a positive number below {:g}",
                                name, scale, kLargest);
  columns.advice =
      "Correct it (tscale is in s, gscale in rad/s and ascale in g), or remove it and state the units in the "
      "header";
  return true;
}

// Scales above the header are for columns whose units it does not state.
void applyScales(const TableHead& head, const TableHeader& header, TextColumns& columns) {
  const TableScales& scales = head.scales;
  if (columns.type != StreamType::Imu || !scales.any()) return;
  const auto isFor = [&](const std::optional<double>& scale, std::size_t column) {
    return scale && column < header.columns.size() && header.columns[column].unit.empty();
  };
  std::string applied;
  const auto state = [&](const std::string& text) { applied += (applied.empty() ? "" : ", ") + text; };
  if (columns.time.size() == 1 && isFor(scales.time_s, columns.time[0].column)) {
    if (refuseScale("tscale", *scales.time_s, columns)) return;
    const double unit_ns = *scales.time_s * kNanosecondsPerSecond,
                 power_ns = std::pow(10.0, std::round(std::log10(unit_ns)));
    const bool exact = unit_ns > 0.5 && std::abs(unit_ns - power_ns) < 1e-9 * power_ns;
    columns.time[0].unit_ns = exact ? std::llround(power_ns) : kSecond_ns;
    columns.time[0].scale = exact ? 1.0 : *scales.time_s;
    columns.notes.clear();  // the unit is not guessed
    state(fmt::format("tscale {}", *scales.time_s));
  }
  if (isFor(scales.rate_rad_s, columns.rate[0])) {
    if (refuseScale("gscale", *scales.rate_rad_s, columns)) return;
    columns.rate_factor.fill(*scales.rate_rad_s);
    state(fmt::format("gscale {} rad/s", *scales.rate_rad_s));
  }
  if (isFor(scales.acceleration_g, columns.acceleration[0])) {
    if (refuseScale("ascale", *scales.acceleration_g, columns)) return;
    columns.acceleration_unit = AccelerationUnit::Gravity;
    columns.acceleration_factor.fill(*scales.acceleration_g);
    state(fmt::format("ascale {} g", *scales.acceleration_g));
  }
  if (!scales.orientation.empty()) {
    if (turnAxes(scales.orientation, columns))
      state("orientation " + scales.orientation);
    else
      columns.notes.push_back(fmt::format(
          "The orientation {} above the header is left-handed, and is not applied.", scales.orientation));
  }
  if (!applied.empty()) columns.scales = "scaled as stated above the header: " + applied;
}

// End of the first cell. Separators within its quotes belong to it: "1,700". Some programs quote whole lines.
std::size_t cellEnd(std::string_view line, std::string_view separators, bool first) {
  const std::size_t end = line.find_first_of(separators);
  if (!line.starts_with('"')) return end;
  const std::size_t quote = line.find('"', 1);
  if (quote == std::string_view::npos || quote < end) return end;
  const std::string_view rest = trimmed(line.substr(quote + 1), " \r");
  if (rest.empty()) return first ? end : std::string_view::npos;
  return separators.find(rest.front()) == std::string_view::npos ? end
                                                                 : line.find_first_of(separators, quote);
}

TextColumns columnsOf(const TableHead& head, std::string_view names, const std::string& file) {
  TextColumns columns;
  const auto apply = [&](const TableHeader& header) {
    applyHeader(header, head.columns, head.rows, sensorNamed(file.substr(0, file.find('.'))), columns);
    applyScales(head, header, columns);
  };
  if (!names.empty()) {
    apply(readTableHeader(names, false));
  } else if (const TableHeader* const header = headerOf(head)) {
    apply(*header);
  } else if (head.has_geometry && head.columns.size() == 4) {
    columns.type = StreamType::Events;  // Metavision's viewer
    columns.x = 0;
    columns.y = 1;
    columns.polarity = 2;
    columns.time = {{3, kMicrosecond_ns}};
  } else if (!followConvention(head, conventionOf(file), columns) && !recogniseEcho(head, columns) &&
             (guessEvents(head, columns) ||
              (!refuseDecimalPixels(head, columns) && guessImu(head, columns)))) {
    std::int64_t& unit_ns = columns.time.front().unit_ns;
    unit_ns = guessUnit_ns(head.columns[columns.time.front().column], columns.type);
    describeGuess(columns);
  }
  return columns;
}

// Checks what the columns contain, and adds what is common to all.
void complete(const TableHead& head, TextColumns& columns) {
  checkUnread(head, columns);
  checkReadable(head, columns);
  checkTimes(head, columns);
  columns.style = head.style;
  columns.first_row = head.first_row;
  if (head.size_px.known()) columns.resolution_px = head.size_px;
}

}  // namespace

std::size_t TextColumns::count() const {
  std::size_t last = 0;
  for (const TimeColumn& part : time) last = std::max(last, part.column);
  if (type == StreamType::Events) return std::max({last, x, y, polarity}) + 1;
  if (type == StreamType::Points) return std::max({last, x, y, point, sigma.value_or(0)}) + 1;
  if (only) last = std::max(last, only->column);
  if (measures(MeasuredBy::Accelerometer))
    last = std::max(last, *std::max_element(acceleration.begin(), acceleration.end()));
  if (measures(MeasuredBy::Gyroscope)) last = std::max(last, *std::max_element(rate.begin(), rate.end()));
  return last + 1;
}

void splitColumns(std::string_view line, std::vector<std::string_view>& columns) {
  splitColumns(line, {line.find_first_of(",;\t") == std::string_view::npos, false}, columns);
}

void splitColumns(std::string_view line, const TextStyle& style, std::vector<std::string_view>& columns) {
  columns.clear();
  if (style.blanks) {
    for (std::string_view column = takeColumn(line); !column.empty(); column = takeColumn(line))
      columns.push_back(column);
    return;
  }
  const std::string_view separators = style.decimal_comma ? ";\t" : ",;\t";
  for (std::size_t end = 0; end != std::string_view::npos;) {
    end = cellEnd(line, separators, columns.empty());
    columns.push_back(trimmed(line.substr(0, end), kAroundCell));
    if (end != std::string_view::npos) line.remove_prefix(end + 1);
  }
  while (!columns.empty() && columns.back().empty()) columns.pop_back();  // after a last comma
}

bool parseCell(std::string_view text, const TextStyle& style, double& number) {
  if (!style.decimal_comma) return parseNumber(text, number);
  return withPoint(text, [&](std::string_view plain) { return parseNumber(plain, number); });
}

// Seconds, and a fraction without leading zeros.
bool parseWithoutZeros(std::string_view text, int digits, std::int64_t& time_ns) {
  const std::size_t point = std::min(text.find('.'), text.size());
  std::int64_t fraction_ns = 0;
  if (!parseSeconds(text.substr(0, point), time_ns)) return false;
  if (point + 1 >= text.size()) return true;
  if (!parseTime(text.substr(point + 1), 9 - digits, fraction_ns) || fraction_ns < 0) return false;
  return !__builtin_add_overflow(time_ns, fraction_ns, &time_ns);
}

bool parseTimePart(std::string_view text, const TimeColumn& part, std::int64_t& time_ns) {
  if (part.fraction_digits > 0) return parseWithoutZeros(text, part.fraction_digits, time_ns);
  if (part.scale == 1.0) return parseTime(text, digitsOf(part.unit_ns), time_ns);
  double number = 0.0;
  if (!parseNumber(text, number)) return false;
  const double scaled_ns = number * part.scale * static_cast<double>(part.unit_ns);
  if (std::abs(scaled_ns) >= static_cast<double>(kLatestTime_ns)) return false;
  time_ns = std::llround(scaled_ns);
  return true;
}

bool parseTimes(const std::vector<std::string_view>& cells, const TextColumns& columns,
                std::int64_t& time_ns) {
  time_ns = 0;
  for (const TimeColumn& part : columns.time) {
    std::int64_t part_ns = 0;
    const std::string_view cell = cells[part.column];
    const auto parse = [&](std::string_view plain) { return parseTimePart(plain, part, part_ns); };
    const bool good = columns.style.decimal_comma ? withPoint(cell, parse) : parse(cell);
    if ((!good && !parseDate(cell, part_ns) && !parseClock(cell, part_ns)) ||
        __builtin_add_overflow(time_ns, part_ns, &time_ns))
      return false;
  }
  return isTime(time_ns);
}

std::string timeOutOfRange(const std::vector<std::string_view>& cells, const TextColumns& columns) {
  const TimeColumn& part = columns.time.front();
  double number = 0.0;
  const auto isTooLarge = [&](std::int64_t unit_ns) {
    return std::abs(number * static_cast<double>(unit_ns)) >= static_cast<double>(kLatestTime_ns);
  };
  if (cells.size() < columns.count() || !parseCell(cells[part.column], columns.style, number) ||
      !isTooLarge(part.unit_ns))
    return "";
  for (std::int64_t unit_ns = part.unit_ns / 1000; unit_ns > 0; unit_ns /= 1000) {
    if (!isTooLarge(unit_ns))
      return fmt::format(
          "{} is too large for a time in {}, but not in {}: name the column's unit in the header or in the "
          "session (columns)",
          cells[part.column], timeUnitName(part.unit_ns), timeUnitName(unit_ns));
  }
  return "";
}

TextColumns findColumns(std::string_view first_bytes, bool cut, std::string_view names,
                        const std::string& file) {
  TableHead head(!names.empty());
  const char line_end = lineEndOf(first_bytes);
  if (first_bytes.starts_with(kByteOrderMark)) first_bytes.remove_prefix(kByteOrderMark.size());
  for (std::uint64_t number = 1; !first_bytes.empty() && head.rows < kMaxRows; ++number) {
    const std::size_t end = first_bytes.find(line_end);
    if (end == std::string_view::npos && cut && number > 1) break;
    const std::string_view line = trimmed(first_bytes.substr(0, end));
    first_bytes.remove_prefix(end == std::string_view::npos ? first_bytes.size() : end + 1);
    if (!line.empty() && !head.add(line, number)) return {};
  }
  TextColumns columns = columnsOf(head, names, file);
  complete(head, columns);
  for (TextColumns& further : columns.further) {
    complete(head, further);
    if (further.problem.empty() || !columns.problem.empty()) continue;
    columns.problem = further.problem;
    columns.advice = further.advice;
  }
  return columns;
}

}  // namespace evical
