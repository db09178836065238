// Access to a list that may be shorter than the list that it is parallel to.
#pragma once

#include <cstddef>
#include <vector>

namespace evical {

// values[i], or an empty element if the list is shorter.
template <class T>
T elementOrNone(const std::vector<T>& values, std::size_t i) {
  return i < values.size() ? values[i] : T{};
}

}  // namespace evical
