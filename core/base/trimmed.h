// A text without blanks at both ends.
#pragma once

#include <algorithm>
#include <string_view>

namespace evical {

// `around`: the characters that count as blanks.
inline std::string_view trimmed(std::string_view text, std::string_view around = " \t\r") {
  const std::size_t begin = std::min(text.find_first_not_of(around), text.size());
  const std::size_t end = text.find_last_not_of(around);
  return end == std::string_view::npos ? std::string_view{} : text.substr(begin, end + 1 - begin);
}

}  // namespace evical
