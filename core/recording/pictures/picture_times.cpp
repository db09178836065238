#include "core/recording/pictures/picture_times.h"

#include "core/recording/pictures/picture_names.h"
#include "core/recording/text/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
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
