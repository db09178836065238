// Meaning of the columns of a text table: by their names, from the file's header line or from the session.
// Without names only documented layouts count, and evidence in the numbers themselves, which is then
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

// One of the columns whose sum is the time: seconds and nanoseconds may be in two.
struct TimeColumn {
  std::size_t column = 0;
  std::int64_t unit_ns = 1'000'000'000;
};

// Notation of a table's lines.
struct TextStyle {
  bool blanks = false;         // only blanks separate columns
  bool decimal_comma = false;  // "1,5" is a number; semicolons or tabs separate columns
};

struct TextColumns {
  StreamType type = StreamType::Other;  // Events, Imu or Points; Other: no table that is understood
  TextStyle style;
  std::vector<TimeColumn> time = {{}};
  std::size_t x = 1, y = 2, polarity = 3;  // of events; x and y also of points
  bool has_types = false;                  // `polarity` is a type: 0 and 1 are events, others something else
  std::size_t point = 1;                   // of points
  std::optional<std::size_t> sigma = {};   // the same, where there is such a column
  std::array<std::size_t, 3> acceleration = {1, 2, 3}, rate = {4, 5, 6};  // of IMU samples: x, y, z
  AccelerationUnit acceleration_unit = AccelerationUnit::MetresPerSecond2;
  AngularRateUnit angular_rate_unit = AngularRateUnit::RadiansPerSecond;
  double acceleration_factor = 1.0, rate_factor = 1.0;  // to these units
  Resolution resolution_px;                             // from a line %geometry:w,h, or e2vid's "w h"
  std::uint64_t first_row = 1;                          // its line; those before it are not rows
  std::vector<std::string> notes;                       // for people: what was guessed, what is not used
  std::string unused;                                   // names of columns that are not read
  std::string problem, advice;  // a table with unidentified columns: why, and what helps

  std::size_t count() const;  // columns that a line must have
  bool isTable() const { return type != StreamType::Other || !problem.empty(); }
};

// From a file's first bytes, of which the last line may be cut off where `cut`. `names`: a header line that
// counts instead of the file's own; "-" for a column that is not used. `convention`: what the file's name says that it is.
TextColumns findColumns(std::string_view first_bytes, bool cut, std::string_view names = {},
                        StreamType convention = StreamType::Other);

// A line's columns; separated by commas, semicolons or tabs where it has any, else by blanks.
void splitColumns(std::string_view line, std::vector<std::string_view>& columns);
void splitColumns(std::string_view line, const TextStyle& style, std::vector<std::string_view>& columns);

// Like parseNumber and parseTime, in the table's style. A time may also be a date of ISO 8601 (UTC without a
// zone).
bool parseCell(std::string_view text, const TextStyle& style, double& number);
bool parseTimes(const std::vector<std::string_view>& cells, const TextColumns& columns,
                std::int64_t& time_ns);

}  // namespace evical
