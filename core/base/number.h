// A number in a text, in C's spelling whatever the locale: strtod would read "0.5" as 0 where decimals have a comma.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace evical {

// All of `text`; nothing if it is no finite number.
inline std::optional<double> realFrom(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool good = error == std::errc{} && end == text.data() + text.size() && std::isfinite(number);
  return good ? std::optional(number) : std::nullopt;
}

}  // namespace evical
