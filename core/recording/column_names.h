// Meaning of a table's column, determined by its name. Has the names that data sets, makers of IMUs and
// programs use: "w_RS_S_x [rad s^-1]", "UncompGyroX", "accelerometer_m_s2[0]", "field.linear_acceleration.z".
// Columns count by their names only, never by their places.
#pragma once

#include "core/data/imu_units.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace evical {

enum class ColumnKind {
  Other,
  Time,
  X,
  Y,
  Polarity,
  EventType,
  Point,
  Sigma,
  Acceleration,
  AngularRate,
  Alpha
};

struct ColumnName {
  ColumnKind kind = ColumnKind::Other;
  int axis = -1;          // of a vector: 0, 1, 2, or 1, 2, 3 where it is numbered so; -1 for all others
  bool lettered = false;  // the axis is x, y or z
  std::string group;      // the name without axis and unit: the three columns of a sensor share it
  std::string unit;       // in lower case, as written in brackets; else as recognised; empty: none
};

ColumnName columnNamed(std::string_view name);

// A unit of a column, as a multiple of one that samples can have.
template <class Unit>
struct ScaledUnit {
  Unit unit;
  double factor = 1.0;
};

// "m/s^2", "g", "mg" and other spellings; "rad/s", "deg/s", "dps", "mdps". Nothing if it is none of them.
std::optional<ScaledUnit<AccelerationUnit>> accelerationUnitOf(std::string_view unit);
std::optional<ScaledUnit<AngularRateUnit>> angularRateUnitOf(std::string_view unit);

// "ns", "us", "ms", "s" and their longer forms.
std::optional<std::int64_t> timeUnitNamed(std::string_view unit);

}  // namespace evical
