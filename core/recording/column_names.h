// Meaning of a table's column, determined by its name. Contains the names that data sets, IMU manufacturers
// and programs use: "w_RS_S_x [rad s^-1]", "UncompGyroX", "accelerometer_m_s2[0]",
// "field.linear_acceleration.z". Only a column's name is used, not its position.
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
  int axis = -1;                // of a vector: 0, 1, 2, or 1, 2, 3 if numbered from 1; -1 for all others
  bool lettered = false;        // the axis is x, y or z
  std::string group;            // the name without axis and unit: the three columns of a sensor share it
  std::string unit;             // in lower case, as written in brackets; else as recognised; empty: none
  std::string imu;              // of a vector: the words that may name one of several IMUs
  bool of_stage = false;        // of a vector: raw, filtered or calibrated values of a sensor
  int bare_axis = -1;           // "x", "y", "z" of an unnamed sensor
  bool other_quantity = false;  // known not to be one of an IMU's six
  bool numbers_imus = false;    // contains the number of the row's IMU
};

ColumnName columnNamed(std::string_view name);

// Unit of a column, as a multiple of the unit of samples.
template <class Unit>
struct ScaledUnit {
  Unit unit;
  double factor = 1.0;
};

// Sensor that a file's name names: "Gyroscope.csv". nullopt if none or both.
std::optional<MeasuredBy> sensorNamed(std::string_view name);

// "m/s^2", "g", "mg" and other spellings; "rad/s", "deg/s", "dps", "mdps"; also a number of these, "0.000488
// g". nullopt for others.
std::optional<ScaledUnit<AccelerationUnit>> accelerationUnitOf(std::string_view unit);
std::optional<ScaledUnit<AngularRateUnit>> angularRateUnitOf(std::string_view unit);

// "ns", "us", "ms", "s" and their longer forms.
std::optional<std::int64_t> timeUnitNamed(std::string_view unit);

}  // namespace evical
