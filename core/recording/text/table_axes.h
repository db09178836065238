// Columns of a table's header that are the axes of a sensor.
#pragma once

#include "core/recording/text/table_header.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace evical {

using Axes = std::array<std::size_t, 3>;  // columns of x, y and z

std::vector<std::size_t> columnsOfKind(const TableHeader& header, ColumnKind kind);

// Columns of each complete group of three.
std::vector<Axes> vectorsOf(const TableHeader& header, ColumnKind kind);

// Header lines of any IMU; Kalibr's table is "timestamp, omega_x, ..., alpha_x, ...".
std::vector<Axes> accelerationsOf(const TableHeader& header);

// The three columns "x", "y" and "z" of a sensor that the header does not name.
std::optional<Axes> bareAxesOf(const TableHeader& header);

// Names bare axes by their unit, otherwise by the sensor that the file's name names.
void nameBareAxes(std::optional<MeasuredBy> by_file, TableHeader& header);

}  // namespace evical
