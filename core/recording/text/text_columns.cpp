#include "core/recording/text/text_columns.h"

#include "core/base/time.h"
#include "core/base/trimmed.h"
#include "core/numerics/robust.h"
#include "core/recording/column_guess.h"
#include "core/recording/text/table_header.h"
#include "core/recording/text/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>

namespace evical {
namespace {

constexpr std::string_view kAroundCell = " \t\r\"'";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kMostRows = 2000;
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

bool cellNumber(std::string_view text, const TextStyle& style, double& number) {
  if (text == "true" || text == "True") return number = 1.0, true;
  if (text == "false" || text == "False") return number = 0.0, true;
  std::int64_t date_ns = 0;
  if (parseDate(text, date_ns)) return number = 1e-9 * static_cast<double>(date_ns), true;
  return parseCell(text, style, number);
}

// "1,5" with digits on both sides.
bool hasDecimalComma(std::string_view cell) {
  const std::size_t comma = cell.find(',');
  const auto isDigit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  return comma != std::string_view::npos && comma > 0 && comma + 1 < cell.size() &&
         isDigit(cell[comma - 1]) && isDigit(cell[comma + 1]) &&
         cell.find(',', comma + 1) == std::string_view::npos;
}

TextStyle styleOf(std::string_view line) {
  TextStyle style;
  if (line.find_first_of(",;\t") == std::string_view::npos) style.blanks = true;
  if (line.find_first_of(";\t") == std::string_view::npos) return style;
  TextStyle comma = style;
  comma.decimal_comma = true;
  std::vector<std::string_view> cells;
  splitColumns(line, comma, cells);
  double number = 0.0;
  const bool all = std::all_of(cells.begin(), cells.end(), [&](std::string_view cell) {
    return cell.find(',') == std::string_view::npos ||
           (hasDecimalComma(cell) && parseCell(cell, comma, number));
  });
  return all && std::any_of(cells.begin(), cells.end(), hasDecimalComma) ? comma : style;
}

// First lines of a table: rows of numbers, and the lines above them.
class TableHead {
 public:
  // `line` has its number in the file. False if the text is not a table.
  bool add(std::string_view line, std::uint64_t number) {
    if (rows == 0) first_row = number + 1;
    if (line.substr(0, 4) == "sep=" || readGeometry(line)) return true;
    const bool comment = line.starts_with('#') || line.starts_with('%') || line.starts_with("//");
    if (comment && rows > 0) return true;
    if (!comment && rows == 0) style = styleOf(line);
    if (!comment && addRow(line)) {
      if (rows++ == 0) first_row = number;
      return true;
    }
    if (rows > 0) return true;  // the reader reports a bad line among rows
    if (!comment && number == 1 && readSize(line)) return true;
    const bool is_text =
        std::none_of(line.begin(), line.end(), [](unsigned char c) { return c < ' ' && c != '\t'; });
    const bool named = comment || std::isalpha(static_cast<unsigned char>(line.front())) != 0 ||
                       std::string_view("_,;\"'").find(line.front()) != std::string_view::npos;
    if (!is_text || !named) return false;
    headers.push_back(readTableHeader(line, comment));
    return true;
  }

  TextStyle style;
  std::vector<TableColumn> columns;
  std::vector<TableHeader> headers;               // lines above the rows that may name columns
  std::vector<double> first_norms, second_norms;  // of columns 1-3 and 4-6, if these exist
  std::size_t rows = 0;
  std::uint64_t first_row = 1;
  Resolution size_px;
  bool has_geometry = false;

 private:
  bool readGeometry(std::string_view line) {
    constexpr std::string_view kGeometry = "%geometry:";
    if (!line.starts_with(kGeometry)) return false;
    has_geometry = true;
    readSize(line.substr(kGeometry.size()));
    return true;
  }

  // Two whole numbers: width and height, as in e2vid's first line.
  bool readSize(std::string_view line) {
    std::vector<std::string_view> sides;
    splitColumns(line, sides);
    std::uint16_t width = 0, height = 0;
    if (sides.size() != 2 || !parseNumber(sides[0], width) || !parseNumber(sides[1], height)) return false;
    size_px = {width, height};
    return true;
  }

  bool addRow(std::string_view line) {
    splitColumns(line, style, cells_);
    numbers_.assign(cells_.size(), 0.0);
    std::vector<bool> is_number(cells_.size());
    for (std::size_t i = 0; i < cells_.size(); ++i) is_number[i] = cellNumber(cells_[i], style, numbers_[i]);
    const auto count = static_cast<std::size_t>(std::count(is_number.begin(), is_number.end(), true));
    if (count < 3 || 2 * count < cells_.size() || (rows > 0 && cells_.size() != columns.size())) return false;
    columns.resize(cells_.size());
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (!is_number[i]) {
        ++columns[i].texts;
        continue;
      }
      columns[i].numbers.add(numbers_[i], columns[i].values.empty());
      columns[i].values.push_back(numbers_[i]);
    }
    if (cells_.size() >= kImuColumns) {
      first_norms.push_back(std::hypot(numbers_[1], numbers_[2], numbers_[3]));
      second_norms.push_back(std::hypot(numbers_[4], numbers_[5], numbers_[6]));
    }
    return true;
  }

  std::vector<std::string_view> cells_;
  std::vector<double> numbers_;
};

bool isGravity(double norm) {
  return std::abs(norm - kStandardGravity_m_s2) < 0.8 || std::abs(norm - 1.0) < 0.08;
}

std::vector<ColumnNumbers> numbersOf(const TableHead& head) {
  std::vector<ColumnNumbers> numbers;
  for (const TableColumn& column : head.columns) numbers.push_back(column.numbers);
  return numbers;
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

// `ros2 topic echo --csv` of sensor_msgs/Imu: seconds, nanoseconds, frame, orientation and its covariance, rates and
// theirs, accelerations and theirs.
bool recogniseEcho(const TableHead& head, TextColumns& columns) {
  if (head.columns.size() != kEchoedImuColumns || head.columns[2].numbers.isPixel()) return false;
  const auto whole = [&](std::size_t i) {
    return head.columns[i].texts == 0 && head.columns[i].numbers.whole;
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
    columns.advice = columnsAdvice("t_s,ax,ay,az,gx,gy,gz");
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
  return convention != StreamType::Other;
}

TextColumns columnsOf(const TableHead& head, std::string_view names, StreamType convention) {
  TextColumns columns;
  if (!names.empty()) {
    const TableHeader header = readTableHeader(names, false);
    applyHeader(header, head.columns, head.rows, columns);
  } else if (const TableHeader* const header = headerOf(head)) {
    applyHeader(*header, head.columns, head.rows, columns);
  } else if (head.has_geometry && head.columns.size() == 4) {
    columns.type = StreamType::Events;  // Metavision's viewer
    columns.x = 0;
    columns.y = 1;
    columns.polarity = 2;
    columns.time = {{3, kMicrosecond_ns}};
  } else if (!followConvention(head, convention, columns) && !recogniseEcho(head, columns) &&
             (guessEvents(head, columns) || guessImu(head, columns))) {
    std::int64_t& unit_ns = columns.time.front().unit_ns;
    unit_ns = guessUnit_ns(head.columns[columns.time.front().column], columns.type);
    describeGuess(columns);
  }
  columns.style = head.style;
  columns.first_row = head.first_row;
  if (head.size_px.known()) columns.resolution_px = head.size_px;
  return columns;
}

}  // namespace

std::size_t TextColumns::count() const {
  std::size_t last = 0;
  for (const TimeColumn& part : time) last = std::max(last, part.column);
  if (type == StreamType::Events) return std::max({last, x, y, polarity}) + 1;
  if (type == StreamType::Points) return std::max({last, x, y, point, sigma.value_or(0)}) + 1;
  return std::max({last, *std::max_element(acceleration.begin(), acceleration.end()),
                   *std::max_element(rate.begin(), rate.end())}) +
         1;
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
    end = line.find_first_of(separators);
    columns.push_back(trimmed(line.substr(0, end), kAroundCell));
    if (end != std::string_view::npos) line.remove_prefix(end + 1);
  }
  while (!columns.empty() && columns.back().empty()) columns.pop_back();  // after a last comma
}

bool parseCell(std::string_view text, const TextStyle& style, double& number) {
  if (!style.decimal_comma) return parseNumber(text, number);
  return withPoint(text, [&](std::string_view plain) { return parseNumber(plain, number); });
}

bool parseTimes(const std::vector<std::string_view>& cells, const TextColumns& columns,
                std::int64_t& time_ns) {
  time_ns = 0;
  for (const TimeColumn& part : columns.time) {
    std::int64_t part_ns = 0;
    const std::string_view cell = cells[part.column];
    const int digits = digitsOf(part.unit_ns);
    const auto parse = [&](std::string_view plain) { return parseTime(plain, digits, part_ns); };
    const bool good = columns.style.decimal_comma ? withPoint(cell, parse) : parse(cell);
    if ((!good && !parseDate(cell, part_ns)) || __builtin_add_overflow(time_ns, part_ns, &time_ns))
      return false;
  }
  return isTime(time_ns);
}

TextColumns findColumns(std::string_view first_bytes, bool cut, std::string_view names,
                        StreamType convention) {
  TableHead head;
  const char line_end = lineEndOf(first_bytes);
  if (first_bytes.starts_with(kByteOrderMark)) first_bytes.remove_prefix(kByteOrderMark.size());
  for (std::uint64_t number = 1; !first_bytes.empty() && head.rows < kMostRows; ++number) {
    const std::size_t end = first_bytes.find(line_end);
    if (end == std::string_view::npos && cut && number > 1) break;
    const std::string_view line = trimmed(first_bytes.substr(0, end));
    first_bytes.remove_prefix(end == std::string_view::npos ? first_bytes.size() : end + 1);
    if (!line.empty() && !head.add(line, number)) return {};
  }
  return columnsOf(head, names, convention);
}

}  // namespace evical
