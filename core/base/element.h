// Lists that run parallel to another may be shorter than it.
#pragma once

#include <cstddef>
#include <vector>

namespace evical {

// The element there, or an empty one if the list is shorter.
template <class T>
T elementOrNone(const std::vector<T>& values, std::size_t i) {
  return i < values.size() ? values[i] : T{};
}

}  // namespace evical
