// Meaning of the columns of a text table: by their names, from the file's header line or from the session.
// Without names only documented layouts are recognised, and evidence in the numbers themselves, which is then
// reported.
#pragma once

#include "core/data/recording.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

// Column of the time, which is the sum of several: seconds and nanoseconds may be separate.
struct TimeColumn {
  std::size_t column = 0;
  std::int64_t unit_ns = 1'000'000'000;
  int fraction_digits = 0;  // if not 0: "12.5" is 12 s and 5 units of 10^-digits s, without leading zeros
  double scale = 1.0;       // of a table that states one: what its numbers are multiplied by
};

// Rows of one of several IMUs in a table: those with this text in this column.
struct RowSelection {
  std::size_t column = 0;
  std::string text;
};

// Notation of a table's lines.
struct TextStyle {
  bool blanks = false;         // only blanks separate columns
  bool decimal_comma = false;  // "1,5" is a number; semicolons or tabs separate columns
};

struct TextColumns {
  StreamType type = StreamType::Other;  // Events, Imu or Points; Other: unknown table
  TextStyle style;
  std::vector<TimeColumn> time = {{}};
  std::size_t x = 1, y = 2, polarity = 3;  // of events; x and y also of points
  bool has_types = false;                  // `polarity` is a type: 0 and 1 are events, others something else
  std::size_t point = 1;                   // of points
  std::optional<std::size_t> sigma = {};   // if that column exists
  std::array<std::size_t, 3> acceleration = {1, 2, 3}, rate = {4, 5, 6};  // of IMU samples: x, y, z
  AccelerationUnit acceleration_unit = AccelerationUnit::MetresPerSecond2;
  AngularRateUnit angular_rate_unit = AngularRateUnit::RadiansPerSecond;
  std::array<double, 3> acceleration_factor = {1.0, 1.0, 1.0},
                        rate_factor = {1.0, 1.0, 1.0};  // to these units
  MeasuredBy measured_by = MeasuredBy::Both;            // of IMU samples
  bool clock_times = false;                             // times of day without a date
  std::optional<RowSelection> only = {};
  std::string part = {};             // name of the IMU, if the table has several
  std::vector<TextColumns> further;  // of the other IMUs
  Resolution resolution_px;          // from a line %geometry:w,h, or e2vid's "w h"
  std::uint64_t first_row = 1;       // its line; earlier lines are not rows
  std::vector<std::string> notes;    // for people: guesses and unused columns
  std::string unused;                // names of columns that are not read
  std::string scales;                // what was multiplied, for people
  std::string problem, advice;       // for unidentified columns: reason and advice

  std::size_t count() const;  // columns that a line must have
  bool measures(MeasuredBy sensor) const { return measured_by == MeasuredBy::Both || measured_by == sensor; }
  bool isTable() const { return type != StreamType::Other || !problem.empty(); }
};

// From a file's first bytes, whose last line may be cut off if `cut`. `names`: a header line that
// replaces the file's own; "-" for an unused column. `file`: its name, which may tell its type or sensor.
TextColumns findColumns(std::string_view first_bytes, bool cut, std::string_view names = {},
                        const std::string& file = {});

// A line's columns; separated by commas, semicolons or tabs if it has any, otherwise by blanks.
void splitColumns(std::string_view line, std::vector<std::string_view>& columns);
void splitColumns(std::string_view line, const TextStyle& style, std::vector<std::string_view>& columns);

// parseNumber and parseTime in the table's style. A time may also be a date of ISO 8601 (UTC without a
// zone).
bool parseCell(std::string_view text, const TextStyle& style, double& number);
bool parseTimes(const std::vector<std::string_view>& cells, const TextColumns& columns,
                std::int64_t& time_ns);
// That the time is too large for its unit, with the unit that would fit; else empty.
std::string timeOutOfRange(const std::vector<std::string_view>& cells, const TextColumns& columns);

}  // namespace evical
