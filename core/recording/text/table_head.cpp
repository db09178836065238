#include "core/recording/text/table_head.h"

#include "core/base/plain_text.h"
#include "core/recording/text/text_lines.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

namespace evical {
namespace {

constexpr std::size_t kNormColumns = 7;

bool isDigitCharacter(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

// "1,5" with digits on both sides.
bool hasDecimalComma(std::string_view cell) {
  const std::size_t comma = cell.find(',');
  return comma != std::string_view::npos && comma > 0 && comma + 1 < cell.size() &&
         isDigitCharacter(cell[comma - 1]) && isDigitCharacter(cell[comma + 1]) &&
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
  const bool all = std::all_of(cells.begin(), cells.end(), [&](std::string_view cell) {
    return cell.find(',') == std::string_view::npos || hasDecimalComma(cell);
  });
  return all && std::any_of(cells.begin(), cells.end(), hasDecimalComma) ? comma : style;
}

bool isTextLine(std::string_view line) {
  return std::none_of(line.begin(), line.end(), [](unsigned char c) { return c < ' ' && c != '\t'; });
}

bool isAxes(std::string_view text) {
  std::string axes(text);
  std::transform(axes.begin(), axes.end(), axes.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::sort(axes.begin(), axes.end());
  return axes == "xyz";
}

// "nan", "inf".
bool isNotFinite(std::string_view text, double& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size() && !std::isfinite(number);
}

}  // namespace

std::optional<double> cellNumber(std::string_view text, const TextStyle& style) {
  if (text == "true" || text == "True") return 1.0;
  if (text == "false" || text == "False") return 0.0;
  std::int64_t time_ns = 0;
  if (parseDate(text, time_ns) || parseClock(text, time_ns)) return 1e-9 * static_cast<double>(time_ns);
  double number = 0.0;
  return parseCell(text, style, number) ? std::optional(number) : std::nullopt;
}

bool TableHead::add(std::string_view line, std::uint64_t number) {
  if (rows == 0) first_row = number + 1;
  if (line.substr(0, 4) == "sep=" || readGeometry(line)) return true;
  const bool comment = line.starts_with('#') || line.starts_with('%') || line.starts_with("//");
  if (comment && rows > 0) return true;
  if (!comment && rows == 0) style = styleOf(line);
  if (!comment && addRow(line, number)) {
    if (rows++ == 0) first_row = number;
    return true;
  }
  if (rows > 0) return true;  // the reader reports a bad line among rows
  if (!comment && number == 1 && readSize(line)) return true;
  if (!isTextLine(line)) return false;
  readScale(line);
  if (!comment && readUnits(line)) return true;
  const bool named = comment || std::isalpha(static_cast<unsigned char>(line.front())) != 0 ||
                     std::string_view("_,;\"'").find(line.front()) != std::string_view::npos;
  if (!comment && isBelowHeader()) {
    if (unread_line == 0) {
      unread_line = number;
      splitColumns(line, style, cells_);
      unread_cells.assign(cells_.begin(), cells_.end());
    }
    if (!named) return true;
  }
  if (!named) return false;
  headers.push_back(readTableHeader(line, comment));
  return true;
}

bool TableHead::isBelowHeader() const {
  return named_ || std::any_of(headers.begin(), headers.end(),
                               [](const TableHeader& header) { return header.namesTable(); });
}

bool TableHead::readGeometry(std::string_view line) {
  constexpr std::string_view kGeometry = "%geometry:";
  if (!line.starts_with(kGeometry)) return false;
  has_geometry = true;
  readSize(line.substr(kGeometry.size()));
  return true;
}

// Two whole numbers: width and height, as in e2vid's first line.
bool TableHead::readSize(std::string_view line) {
  std::vector<std::string_view> sides;
  splitColumns(line, sides);
  std::uint16_t width = 0, height = 0;
  if (sides.size() != 2 || !parseNumber(sides[0], width) || !parseNumber(sides[1], height)) return false;
  size_px = {width, height};
  return true;
}

bool TableHead::readScale(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(" \t,;:=#%/"); at != std::string_view::npos;
       at = line.find_first_not_of(" \t,;:=", at)) {
    const std::size_t end = std::min(line.find_first_of(" \t,;:=", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  if (words.size() != 2) return false;
  if (words[0] == "orientation" && isAxes(words[1])) {
    scales.orientation = words[1];
    return true;
  }
  std::optional<double>* const scale = words[0] == "tscale"   ? &scales.time_s
                                       : words[0] == "gscale" ? &scales.rate_rad_s
                                       : words[0] == "ascale" ? &scales.acceleration_g
                                                              : nullptr;
  double factor = 0.0;
  if (scale == nullptr || (!parseNumber(words[1], factor) && !isNotFinite(words[1], factor))) return false;
  *scale = factor;
  return true;
}

// A line of units below the names.
bool TableHead::readUnits(std::string_view line) {
  if (headers.empty() || !headers.back().namesTable()) return false;
  TableHeader& header = headers.back();
  splitColumns(line, style, cells_);
  if (cells_.size() != header.columns.size()) return false;
  std::vector<std::string> units;
  std::size_t known = 0;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    units.push_back(
        columnNamed(header.names[i] + " [" + std::string(trimmed(cells_[i], " \t[]()")) + "]").unit);
    const ColumnKind kind = header.columns[i].kind;
    known += (kind == ColumnKind::Time && timeUnitNamed(units[i])) ||
             (kind == ColumnKind::Acceleration && accelerationUnitOf(units[i])) ||
             (kind == ColumnKind::AngularRate && angularRateUnitOf(units[i]));
  }
  if (known < 3) return false;
  for (std::size_t i = 0; i < units.size(); ++i)
    if (header.columns[i].unit.empty()) header.columns[i].unit = units[i];
  return true;
}

bool TableHead::addRow(std::string_view line, std::uint64_t number) {
  splitColumns(line, style, cells_);
  numbers_.assign(cells_.size(), 0.0);
  std::vector<bool> is_number(cells_.size());
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const std::optional<double> value = cellNumber(cells_[i], style);
    is_number[i] = value.has_value();
    numbers_[i] = value.value_or(0.0);
  }
  const auto count = static_cast<std::size_t>(std::count(is_number.begin(), is_number.end(), true));
  const auto longer = [&](const TableHeader& header) {
    return header.namesTable() && header.names.size() > cells_.size();
  };
  if (rows == 0 && std::any_of(headers.begin(), headers.end(), longer))
    return false;  // its last cells are empty
  if (count < 3 || 2 * count < cells_.size() || (rows > 0 && cells_.size() != columns.size())) return false;
  columns.resize(cells_.size());
  lines.push_back(number);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    columns[i].cells.push_back(cells_[i]);
    if (!is_number[i]) continue;
    columns[i].numbers.add(numbers_[i], columns[i].values.empty());
    columns[i].values.push_back(numbers_[i]);
  }
  if (cells_.size() >= kNormColumns) {
    first_norms.push_back(std::hypot(numbers_[1], numbers_[2], numbers_[3]));
    second_norms.push_back(std::hypot(numbers_[4], numbers_[5], numbers_[6]));
  }
  return true;
}

}  // namespace evical
