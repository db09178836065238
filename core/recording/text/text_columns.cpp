#include "core/recording/text/text_columns.h"

#include "core/base/trimmed.h"
#include "core/numerics/robust.h"
#include "core/recording/column_guess.h"
#include "core/recording/text/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <optional>

namespace evical {
namespace {

constexpr std::string_view kAroundCell = " \t\r\"'";

constexpr std::size_t kMostRows = 2000;
constexpr std::size_t kImuColumns = 7;

struct Rows {
  std::vector<ColumnNumbers> columns;
  std::vector<double> first_norms, second_norms;  // of columns 1-3 and 4-6, where there are as many
  std::size_t count = 0;
};

bool columnNumber(std::string_view text, double& number) {
  if (text == "true" || text == "True") return number = 1.0, true;
  if (text == "false" || text == "False") return number = 0.0, true;
  return parseNumber(text, number);
}

// False if the line is no row like those before.
bool addRow(const std::vector<std::string_view>& line, Rows& rows) {
  if (line.empty()) return false;
  std::vector<double> numbers(line.size());
  for (std::size_t i = 0; i < line.size(); ++i)
    if (!columnNumber(line[i], numbers[i])) return false;
  if (rows.count == 0) rows.columns.resize(line.size());
  if (line.size() != rows.columns.size()) return false;
  for (std::size_t i = 0; i < numbers.size(); ++i) rows.columns[i].add(numbers[i], rows.count == 0);
  if (numbers.size() >= kImuColumns) {
    rows.first_norms.push_back(std::hypot(numbers[1], numbers[2], numbers[3]));
    rows.second_norms.push_back(std::hypot(numbers[4], numbers[5], numbers[6]));
  }
  ++rows.count;
  return true;
}

bool isGravity(double norm) {
  return std::abs(norm - kStandardGravity_m_s2) < 0.8 || std::abs(norm - 1.0) < 0.08;
}

bool startsWithOne(std::string_view name, std::initializer_list<std::string_view> starts) {
  return std::any_of(starts.begin(), starts.end(), [&](std::string_view s) { return name.starts_with(s); });
}

// The letters in front of a unit or an index.
std::string_view stem(std::string_view name) {
  return name.substr(0, std::min(name.find_first_of("_[( "), name.size()));
}

bool isOneOf(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

struct HeaderColumns {
  std::optional<std::size_t> time, x, y, polarity, acceleration, rate, point, sigma, alpha;
  std::optional<std::int64_t> unit_ns;
  AccelerationUnit acceleration_unit = AccelerationUnit::MetresPerSecond2;
  AngularRateUnit angular_rate_unit = AngularRateUnit::RadiansPerSecond;

  bool nameEvents() const { return time && x && y && polarity; }
  bool nameImu() const { return time && acceleration && rate; }
  bool namePoints() const { return time && point && x && y; }

  // Kalibr's table is "timestamp, omega_x, ..., alpha_x, ...", in ns; elsewhere alpha is a rate.
  void takeKalibrs() {
    if (!rate || acceleration || !alpha) return;
    acceleration = alpha;
    if (time && !unit_ns) unit_ns = 1;
  }

  void add(std::string_view name, std::size_t i) {
    const auto first = [i](std::optional<std::size_t>& column) {
      if (!column) column = i;
    };
    const std::string_view letters = stem(name);
    if (startsWithOne(name, {"ang", "gyr", "w_", "wx", "gx", "omega"})) {
      if (name.find("deg") != std::string_view::npos) angular_rate_unit = AngularRateUnit::DegreesPerSecond;
      first(rate);
    } else if (name.starts_with("alpha")) {
      first(alpha);
    } else if (startsWithOne(name, {"acc", "lin", "a_", "ax"})) {
      if (name.ends_with("[g]") || name.ends_with("(g)")) acceleration_unit = AccelerationUnit::Gravity;
      first(acceleration);
    } else if (!time && (startsWithOne(name, {"time", "stamp"}) || isOneOf(letters, {"t", "ts", "sec"}))) {
      time = i;
      unit_ns = timeUnitOf(name);
    } else if (letters == "x") {
      first(x);
    } else if (letters == "y") {
      first(y);
    } else if (isOneOf(letters, {"p", "pol", "polarity", "on"})) {
      first(polarity);
    } else if (isOneOf(letters, {"point", "circle", "corner"})) {
      first(point);
    } else if (isOneOf(letters, {"sigma", "std"})) {
      first(sigma);
    }
  }
};

HeaderColumns readHeaderLine(std::string_view line) {
  std::string lower(line);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  std::string_view names = trimmed(lower, kAroundCell);
  while (names.starts_with('#') || names.starts_with('%')) names = trimmed(names.substr(1), kAroundCell);
  std::vector<std::string_view> columns;
  splitColumns(names, columns);
  HeaderColumns header;
  for (std::size_t i = 0; i < columns.size(); ++i) header.add(trimmed(columns[i], kAroundCell), i);
  header.takeKalibrs();
  return header;
}

bool readGeometry(std::string_view line, Resolution& size_px) {
  constexpr std::string_view kGeometry = "%geometry:";
  if (!line.starts_with(kGeometry)) return false;
  std::vector<std::string_view> sides;
  splitColumns(line.substr(kGeometry.size()), sides);
  std::uint16_t width = 0, height = 0;
  if (sides.size() == 2 && parseNumber(sides[0], width) && parseNumber(sides[1], height))
    size_px = {width, height};
  return true;
}

void applyHeader(const HeaderColumns& header, TextColumns& columns) {
  columns.type = header.nameEvents() ? StreamType::Events
                 : header.nameImu()  ? StreamType::Imu
                                     : StreamType::Points;
  columns.time = *header.time;
  columns.x = header.x.value_or(0);
  columns.y = header.y.value_or(0);
  columns.polarity = header.polarity.value_or(0);
  columns.point = header.point.value_or(0);
  columns.sigma = header.sigma;
  columns.acceleration = header.acceleration.value_or(0);
  columns.rate = header.rate.value_or(0);
  columns.acceleration_unit = header.acceleration_unit;
  columns.angular_rate_unit = header.angular_rate_unit;
  columns.time_unit_ns = header.unit_ns.value_or(0);
}

bool guessEvents(const Rows& rows, TextColumns& columns) {
  const std::optional<EventColumns> events = guessEventColumns(rows.columns);
  if (!events) return false;
  columns.type = StreamType::Events;
  columns.time = events->time;
  columns.x = events->x;
  columns.y = events->y;
  columns.polarity = events->polarity;
  return true;
}

bool guessImu(const Rows& rows, TextColumns& columns) {
  if (rows.columns.size() != kImuColumns) return false;
  columns.type = StreamType::Imu;
  const bool rate_first = isGravity(medianOf(rows.second_norms)) && !isGravity(medianOf(rows.first_norms));
  columns.rate = rate_first ? 1 : 4;
  columns.acceleration = rate_first ? 4 : 1;
  return true;
}

void describeGuess(TextColumns& columns, bool has_header) {
  const char* unit = timeUnitName(columns.time_unit_ns);
  if (has_header) {
    columns.guess = fmt::format("The header does not tell the unit of time; {} is assumed.", unit);
    return;
  }
  std::string order;
  const auto name = [&](std::size_t i) -> const char* {
    if (i == columns.time) return "t";
    if (columns.type == StreamType::Events) return i == columns.x ? "x" : i == columns.y ? "y" : "p";
    constexpr const char *kAcceleration[] = {"ax", "ay", "az"}, *kRate[] = {"gx", "gy", "gz"};
    return i - columns.acceleration < 3 ? kAcceleration[i - columns.acceleration] : kRate[i - columns.rate];
  };
  for (std::size_t i = 0; i < columns.count(); ++i) order += fmt::format("{}{}", i == 0 ? "" : ",", name(i));
  const bool conventional =
      (order == "t,x,y,p" || order == "t,ax,ay,az,gx,gy,gz") && columns.time_unit_ns == 1'000'000'000;
  if (conventional) return;
  columns.guess = fmt::format(
      "There is no header; the columns are taken for {}, t in {}. If that is wrong, put a "
      "line such as \"t_{},x,y,p\" on top.",
      order, unit, unit);
}

}  // namespace

std::size_t TextColumns::count() const {
  if (type == StreamType::Events) return std::max({time, x, y, polarity}) + 1;
  if (type == StreamType::Points) return std::max({time, x, y, point, sigma.value_or(0)}) + 1;
  return std::max({time, acceleration + 2, rate + 2}) + 1;
}

void splitColumns(std::string_view line, std::vector<std::string_view>& columns) {
  columns.clear();
  if (line.find_first_of(",;\t") == std::string_view::npos) {
    for (std::string_view column = takeColumn(line); !column.empty(); column = takeColumn(line))
      columns.push_back(column);
    return;
  }
  for (std::size_t end = 0; end != std::string_view::npos;) {
    end = line.find_first_of(",;\t");
    columns.push_back(trimmed(line.substr(0, end), kAroundCell));
    if (end != std::string_view::npos) line.remove_prefix(end + 1);
  }
  while (!columns.empty() && columns.back().empty()) columns.pop_back();  // behind a last comma
}

TextColumns findColumns(std::string_view first_bytes, bool cut) {
  TextColumns columns;
  Rows rows;
  std::vector<std::string_view> parts;
  bool has_header = false, metavision = false;
  const char line_end = lineEndOf(first_bytes);
  for (std::uint64_t number = 1; !first_bytes.empty() && rows.count < kMostRows; ++number) {
    const std::size_t end = first_bytes.find(line_end);
    if (end == std::string_view::npos && cut && number > 1) break;
    const std::string_view line = trimmed(first_bytes.substr(0, end), kAroundCell);
    first_bytes.remove_prefix(end == std::string_view::npos ? first_bytes.size() : end + 1);
    if (line.empty()) continue;
    if (readGeometry(line, columns.resolution_px)) {
      metavision = true;
      continue;
    }
    splitColumns(line, parts);
    if (addRow(parts, rows) || rows.count > 0) continue;  // a bad line among rows is the reader's to report
    const HeaderColumns header = readHeaderLine(line);
    if (!has_header && (header.nameEvents() || header.nameImu() || header.namePoints())) {
      applyHeader(header, columns);
      columns.header_line = number;
      has_header = true;
    } else if (line.front() != '#' && line.front() != '%' &&
               std::isalpha(static_cast<unsigned char>(line.front())) == 0) {
      return columns;  // neither a row, nor names, nor a comment
    }
  }
  if (metavision && !has_header && rows.columns.size() == 4) {
    columns.type = StreamType::Events;
    columns.x = 0;
    columns.y = 1;
    columns.polarity = 2;
    columns.time = 3;
    columns.time_unit_ns = 1000;
    return columns;
  }
  if (!has_header && !guessEvents(rows, columns) && !guessImu(rows, columns)) return columns;
  if (has_header && columns.time_unit_ns != 0) return columns;
  const bool known = columns.time < rows.columns.size();
  columns.time_unit_ns = known ? guessTimeUnit_ns(rows.columns[columns.time], rows.count) : 1'000'000'000;
  const bool obvious = has_header && known && !rows.columns[columns.time].whole;
  if (!obvious) describeGuess(columns, has_header);
  return columns;
}

}  // namespace evical
