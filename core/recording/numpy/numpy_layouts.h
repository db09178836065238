// Arrays of events in a file or folder, identified by their names and types, and otherwise by their numbers:
//   structured arrays with fields like x, y, t, p (tonic, dv, Metavision, expelliarmus, N-ImageNet's
//   event_data), arrays of one field each (vid2e, e2vid, DSEC's names with t_offset), also xy (EVIMO2,
//   event_utils) and xyp, rows or columns of four numbers (EVIMO, data of RPG), which are identified by the
//   numbers.
#pragma once

#include "core/recording/numpy/numpy_columns.h"

#include "core/geometry/resolution.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace evical::numpy {

struct EventLayout {
  std::string name;               // of the stream
  std::string message;            // description of the arrays, for people
  std::array<Column, 4> columns;  // x, y, t, p
  std::uint64_t rows = 0;         // common to all columns
  std::int64_t unit_ns = 1000;    // of time
  std::int64_t offset_ns = 0;     // to add to times
  double step_ns = 0.0;           // between two times, if these are real numbers of too few bits
  Resolution size_px;
  std::string guess;    // sentence on a guess, for people; empty if none
  std::string problem;  // rows missing in some columns
};

struct FoundArrays {
  std::vector<EventLayout> events;
  std::vector<std::string> problems;  // sentences on omitted arrays
  std::vector<const Array*> others;   // not part of events
};

// The arrays must outlive the result.
FoundArrays findEvents(const std::vector<Array>& arrays);

// True if arrays of these names are a stream of events: x, y, t, p in any of the spellings.
bool nameEvents(const std::vector<std::string>& arrays);

}  // namespace evical::numpy

// Part of events in an array or field, determined by its name.

namespace evical::numpy {

enum class Part { None, X, Y, Time, Polarity, Xy, Xyp, TimeOffset, Width, Height };

struct NamedPart {
  Part part = Part::None;
  std::size_t rank = 0;                 // the usual spelling of a part first
  std::string group;                    // the part before: "left" of "left_x", "events" of "events/x"
  std::optional<std::int64_t> unit_ns;  // of a time: "t_us"
};

NamedPart partNamed(std::string_view name);

}  // namespace evical::numpy
