#include "core/recording/text/table_axes.h"

#include <algorithm>
#include <map>
#include <string>

namespace evical {
namespace {

// Sensor of bare axes: by their unit, otherwise by the file's name.
std::optional<MeasuredBy> sensorOf(const TableHeader& header, const Axes& axes,
                                   std::optional<MeasuredBy> by_file) {
  const std::string& unit = header.columns[axes[0]].unit;
  if (accelerationUnitOf(unit)) return MeasuredBy::Accelerometer;
  if (angularRateUnitOf(unit) && unit.find('s') != std::string::npos) return MeasuredBy::Gyroscope;
  return by_file;
}

}  // namespace

std::vector<std::size_t> columnsOfKind(const TableHeader& header, ColumnKind kind) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < header.columns.size(); ++i)
    if (header.columns[i].kind == kind) found.push_back(i);
  return found;
}

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

std::vector<Axes> accelerationsOf(const TableHeader& header) {
  const std::vector<Axes> named = vectorsOf(header, ColumnKind::Acceleration);
  return named.empty() && header.has(ColumnKind::AngularRate) ? vectorsOf(header, ColumnKind::Alpha) : named;
}

std::optional<Axes> bareAxesOf(const TableHeader& header) {
  if (header.has(ColumnKind::Acceleration) || header.has(ColumnKind::AngularRate) ||
      header.has(ColumnKind::Polarity) || header.has(ColumnKind::EventType) || header.has(ColumnKind::Point))
    return std::nullopt;
  Axes axes{};
  std::array<int, 3> count{};
  for (std::size_t i = 0; i < header.columns.size(); ++i) {
    const int axis = header.columns[i].bare_axis;
    if (axis < 0) continue;
    axes[static_cast<std::size_t>(axis)] = i;
    ++count[static_cast<std::size_t>(axis)];
  }
  return count == std::array{1, 1, 1} ? std::optional(axes) : std::nullopt;
}

void nameBareAxes(std::optional<MeasuredBy> by_file, TableHeader& header) {
  const std::optional<Axes> axes = bareAxesOf(header);
  const auto sensor = axes ? sensorOf(header, *axes, by_file) : std::nullopt;
  if (!sensor) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    ColumnName& column = header.columns[(*axes)[axis]];
    column.kind = *sensor == MeasuredBy::Gyroscope ? ColumnKind::AngularRate : ColumnKind::Acceleration;
    column.axis = static_cast<int>(axis);
    column.lettered = true;
    column.group.clear();
  }
}

}  // namespace evical
