// What the columns of a text table mean: by its header line, or guessed from its first rows.
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

struct TextColumns {
  StreamType type = StreamType::Other;  // Events, Imu or Points; Other: no table that is understood
  std::size_t time = 0;
  std::size_t x = 1, y = 2, polarity = 3;  // of events; x and y also of points
  std::size_t point = 1;                   // of points
  std::optional<std::size_t> sigma = {};   // the same, where there is such a column
  std::size_t acceleration = 1, rate = 4;  // of IMU samples: the first of three columns each
  std::int64_t time_unit_ns = 1'000'000'000;
  AccelerationUnit acceleration_unit = AccelerationUnit::MetresPerSecond2;
  AngularRateUnit angular_rate_unit = AngularRateUnit::RadiansPerSecond;
  Resolution resolution_px;       // from a line %geometry:w,h
  std::uint64_t header_line = 0;  // its number, from 1; 0: none
  std::string guess;              // for people; empty where header or convention say it all

  std::size_t count() const;  // columns that a line must have
};

// From a file's first bytes, of which the last line may be cut off where `cut`. The convention without a
// header is "t x y p" or "t ax ay az gx gy gz", in s; what differs from it is a guess. Points have a header:
// "time_s, point, x_px, y_px" and perhaps "sigma_px".
TextColumns findColumns(std::string_view first_bytes, bool cut);

// A line's columns; separated by commas, semicolons or tabs where it has any, else by blanks.
void splitColumns(std::string_view line, std::vector<std::string_view>& columns);

}  // namespace evical
