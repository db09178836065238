#include "core/recording/pictures/picture_times.h"

#include "core/recording/pictures/picture_names.h"
#include "core/recording/text/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace evical::pictures {
namespace {

constexpr int kMicrosecondDigits = 3;  // digits
constexpr double kLongestExposure_s = 1.0;

// Calls `take` with each line that may be a row; it returns false for others.
template <class Take>
void readRows(const std::filesystem::path& table, const char* columns, PictureList& list, const Take& take) {
  TextLines lines(table);
  std::string_view line;
  while (lines.next(line)) {
    std::string_view rest = line;
    const std::string_view first = takeColumn(rest);
    if (first.empty() || first.front() == '#' || take(line) || lines.number() == 1) continue;
    addFault(list, FaultKind::Corrupt,
             fmt::format("Line {} of {} is not \"{}\"; it is left out.", lines.number(),
                         table.filename().string(), columns));
  }
}

// "rgb/1305031102.175304" of "rgb/1305031102.175304.png", within the list's folder.
std::string_view stemOf(std::string_view cell) {
  cell.remove_prefix(std::min(cell.size(), cell.rfind('/') + 1));
  const std::size_t point = cell.rfind('.');
  const bool extension = point != std::string_view::npos && isPictureName(cell);
  return extension ? cell.substr(0, point) : cell;
}

// The column with the name of a picture: with an extension before one without, which may be a number.
std::optional<std::size_t> pictureColumn(const std::vector<std::string_view>& cells,
                                         const std::map<std::string, std::string, std::less<>>& by_stem) {
  const auto isKnown = [&](std::string_view cell) { return by_stem.contains(stemOf(cell)); };
  for (std::size_t k = 0; k < cells.size(); ++k)
    if (isPictureName(cells[k]) && isKnown(cells[k])) return k;
  for (std::size_t k = 0; k < cells.size(); ++k)
    if (isKnown(cells[k])) return k;
  return std::nullopt;
}

std::int64_t middle(std::int64_t a, std::int64_t b) {
  return a + (b - a) / 2;
}

}  // namespace

void addFault(PictureList& list, FaultKind kind, std::string text) {
  const auto alike = [&](const RecordingFault& fault) { return fault.kind == kind; };
  if (std::count_if(list.faults.begin(), list.faults.end(), alike) < kMostAlikeFaults)
    list.faults.push_back({list.name, kind, 0.0, std::move(text)});
}

void readNamedTimes(const std::filesystem::path& table, int unit_digits, PictureList& list) {
  readRows(table, "time, file", list, [&](std::string_view line) {
    Picture picture;
    if (!parseTime(takeColumn(line), unit_digits, picture.time_ns)) return false;
    picture.name = takeColumn(line);
    if (!staysInside(picture.name)) return false;
    list.pictures.push_back(std::move(picture));
    return true;
  });
}

void readAnyTimes(const std::filesystem::path& table, int unit_digits, PictureList& list) {
  std::map<std::string, std::string, std::less<>> by_stem;
  for (const std::string& name : pictureNames(list.folder)) by_stem[name.substr(0, name.rfind('.'))] = name;
  std::vector<TimeRow> rows;
  readRows(table, "time, file", list, [&](std::string_view line) {
    std::vector<std::string_view> cells;
    for (std::string_view cell = takeColumn(line); !cell.empty(); cell = takeColumn(line))
      cells.push_back(cell);
    const std::optional<std::size_t> named = pictureColumn(cells, by_stem);
    const std::size_t first = named == 0 && cells.size() > 1 ? 1 : 0;
    TimeRow row;
    const bool date = cells.size() > first + 1 &&
                      parseDate(fmt::format("{} {}", cells[first], cells[first + 1]), row.first_ns);
    if (!date && !parseDate(cells[first], row.first_ns) &&
        !parseTime(cells[first], unit_digits, row.first_ns))
      return false;
    if (named)
      list.pictures.push_back({row.first_ns, 0.0, by_stem.find(stemOf(cells[*named]))->second});
    else
      rows.push_back(row);
    return true;
  });
  if (list.pictures.empty()) pairWithTimes(rows, false, list);
}

int usualDigits(const std::filesystem::path& table, int of_decimals) {
  TextLines lines(table);
  for (std::string_view line; lines.next(line);) {
    const std::string_view first = takeColumn(line), second = takeColumn(line);
    double number = 0.0;
    if (first.empty() || first.front() == '#' || !parseNumber(first, number)) continue;
    const bool decimals = first.find_first_of(".eE") != std::string_view::npos ||
                          (parseNumber(second, number) && second.find('.') != std::string_view::npos);
    return decimals ? of_decimals : 0;
  }
  return of_decimals;
}

std::vector<TimeRow> readTimes(const std::filesystem::path& table, int unit_digits, bool two_columns,
                               PictureList& list) {
  std::vector<TimeRow> rows;
  readRows(table, two_columns ? "begin, end" : "time", list, [&](std::string_view line) {
    TimeRow row;
    const bool good = parseTime(takeColumn(line), unit_digits, row.first_ns) &&
                      (!two_columns || parseTime(takeColumn(line), unit_digits, row.second_ns));
    if (good) rows.push_back(row);
    return good;
  });
  return rows;
}

void pairWithTimes(const std::vector<TimeRow>& rows, bool two_columns, PictureList& list) {
  const std::vector<std::string> names = pictureNames(list.folder);
  const std::size_t count = std::min(names.size(), rows.size());
  if (names.size() != rows.size()) {
    addFault(list, FaultKind::Metadata,
             fmt::format("There are {} pictures and {} times; the first {} of both are paired.", names.size(),
                         rows.size(), count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const TimeRow& row = rows[i];
    Picture picture{row.first_ns, 0.0, names[i]};
    if (two_columns && row.second_ns >= row.first_ns) {
      picture.time_ns = middle(row.first_ns, row.second_ns);
      picture.exposure_s = 1e-9 * static_cast<double>(row.second_ns - row.first_ns);
    }
    list.pictures.push_back(std::move(picture));
  }
}

void readExposures(const std::filesystem::path& table, PictureList& list) {
  const std::vector<TimeRow> rows = readTimes(table, kMicrosecondDigits, false, list);
  if (rows.size() != list.pictures.size()) {
    addFault(list, FaultKind::Metadata,
             fmt::format("There are {} pictures and {} exposures in {}; the exposures are left out.",
                         list.pictures.size(), rows.size(), table.filename().string()));
    return;
  }
  std::size_t others = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double exposure_s = 1e-9 * static_cast<double>(rows[i].first_ns);
    const bool good = exposure_s > 0.0 && exposure_s <= kLongestExposure_s;
    if (good) list.pictures[i].exposure_s = exposure_s;
    if (!good) ++others;
  }
  if (others == 0) return;
  addFault(list, FaultKind::Metadata,
           fmt::format("{} exposures in {} are not between 0 and 1 s, read as us; they are left out.", others,
                       table.filename().string()));
}

}  // namespace evical::pictures
