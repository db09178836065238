#include "core/pipeline/session/given_points.h"

#include "core/base/error.h"
#include "core/recording/text/text_columns.h"
#include "core/recording/text/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

namespace evical {
namespace {

constexpr std::size_t kMaxPoints = 10'000;
const char* const kFlat = "Give all points in one plane, with the same z or without z";

// Checks that all points are in the plane of the first one.
class Flat {
 public:
  bool take(double z_m) {
    constexpr double kSame_m = 1e-6;
    if (!first_m_) first_m_ = z_m;
    return std::abs(z_m - *first_m_) < kSame_m;
  }

 private:
  std::optional<double> first_m_;
};

struct PointTable {
  std::array<std::size_t, 3> columns = {0, 1, 2};  // of index, x and y
  std::optional<std::size_t> z_column = 3;
  std::size_t min_columns = 3;
  std::vector<std::optional<Eigen::Vector2d>> places_m;
  Flat flat;
};

// Identifies columns by their names.
void readNames(const std::vector<std::string_view>& names, const std::string& place, PointTable& table) {
  constexpr std::array<std::string_view, 3> kNeeded = {"point", "x_m", "y_m"};
  const auto columnOf = [&](std::string_view name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  table.min_columns = 0;
  for (std::size_t k = 0; k < kNeeded.size(); ++k) {
    table.columns.at(k) = columnOf(kNeeded.at(k));
    if (table.columns.at(k) == names.size())
      throw badInput(place, fmt::format("has no column {}", kNeeded.at(k)),
                     "Give the columns point,x_m,y_m: index and position in metres");
    table.min_columns = std::max(table.min_columns, table.columns.at(k) + 1);
  }
  const std::size_t z = columnOf("z_m");
  table.z_column = z < names.size() ? std::optional(z) : std::nullopt;
}

void readPoint(const std::vector<std::string_view>& columns, const std::string& place, PointTable& table) {
  double index = 0.0, z_m = 0.0;
  Eigen::Vector2d at_m;
  const auto parsed = [&](std::size_t k, double& value) {
    return parseNumber(columns[table.columns.at(k)], value);
  };
  if (columns.size() < table.min_columns || !parsed(0, index) || !parsed(1, at_m.x()) ||
      !parsed(2, at_m.y()) ||
      (table.z_column && *table.z_column < columns.size() && !parseNumber(columns[*table.z_column], z_m)))
    throw badInput(place, "is not a point: index, x and y are expected", "Give point,x_m,y_m in each line");
  if (!(index >= 0.0 && index < static_cast<double>(kMaxPoints)) || index != std::floor(index))
    throw badInput(place,
                   fmt::format("{} is not a valid point index: indices are 0 to {}", index, kMaxPoints - 1),
                   "Count the points from 0");
  if (!table.flat.take(z_m))
    throw badInput(place, fmt::format("z is {} m, but different for other points", z_m), kFlat);
  const auto point = static_cast<std::size_t>(index);
  if (point >= table.places_m.size()) table.places_m.resize(point + 1);
  if (table.places_m[point])
    throw badInput(place, fmt::format("point {} is listed twice", point), "Give each point once");
  table.places_m[point] = at_m;
}

}  // namespace

std::vector<Eigen::Vector2d> pointsFrom(const YamlNode& list) {
  std::vector<Eigen::Vector2d> points_m;
  Flat flat;
  for (const YamlNode& item : list.items()) {
    const std::vector<YamlNode> numbers = item.items();
    if (numbers.size() != 2 && numbers.size() != 3) throw item.error("must be [x, y] in metres");
    if (points_m.size() == kMaxPoints)
      throw item.error(fmt::format("exceeds the maximum of {} points per board", kMaxPoints));
    points_m.emplace_back(numbers[0].real(), numbers[1].real());
    const double z_m = numbers.size() > 2 ? numbers[2].real() : 0.0;
    if (!flat.take(z_m))
      throw item.error(fmt::format("z is {} m, but different for other points", z_m), kFlat);
  }
  return points_m;
}

std::vector<Eigen::Vector2d> loadPoints(const std::filesystem::path& file) {
  PointTable table;
  TextLines lines(file);
  bool begun = false;
  std::vector<std::string_view> columns;
  for (std::string_view line; lines.next(line);) {
    splitColumns(line, columns);
    if (columns.empty() || columns.front().starts_with('#')) continue;
    const std::string place = fmt::format("{}: line {}", file.string(), lines.number());
    double number = 0.0;
    if (!begun && !parseNumber(columns.front(), number))
      readNames(columns, place, table);
    else
      readPoint(columns, place, table);
    begun = true;
  }
  std::vector<Eigen::Vector2d> points_m;
  for (std::size_t point = 0; point < table.places_m.size(); ++point) {
    if (!table.places_m[point])
      throw badInput(file.string(),
                     fmt::format("point {} is missing, but there are indices up to {}", point,
                                 table.places_m.size() - 1),
                     "Give each point once, counted from 0");
    points_m.push_back(*table.places_m[point]);
  }
  return points_m;
}

std::string pointsYaml(const Board& board) {
  std::string text;
  for (const Eigen::Vector2d& point_m : board.given_m)
    text += fmt::format("{}[{}, {}]", text.empty() ? "" : ", ", point_m.x(), point_m.y());
  return "[" + text + "]";
}

}  // namespace evical
