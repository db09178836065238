// Part of events in an array or field, determined by its name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

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
