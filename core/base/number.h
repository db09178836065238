// Numbers from texts, and as texts. A number in a text is in C's spelling whatever the locale: strtod would read "0.5" as 0 where decimals have a comma.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
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

// Decimals that show a number to its sigma's second digit; `without` where it has no sigma.
int decimalsFor(double sigma, int most = 6, int without = 4);

// "12.345 +- 0.012"; the value alone where it has no sigma.
std::string withSigma(double value, double sigma, std::string_view between = " +- ");

}  // namespace evical
