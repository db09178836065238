// Conversion between numbers and texts. Texts use C's spelling in any locale: strtod would read "0.5" as 0 if
// the locale has decimal commas.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace evical {

// All of `text` as a number; empty if it is not a finite number.
inline std::optional<double> realFrom(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool good = error == std::errc{} && end == text.data() + text.size() && std::isfinite(number);
  return good ? std::optional(number) : std::nullopt;
}

// Number of decimals that shows a value to its sigma's second digit; `without` if it has no sigma.
int decimalsFor(double sigma, int most = 6, int without = 4);

// "1 event", "3 events"; with verbs "1 event was", "3 events were".
std::string counted(std::uint64_t count, std::string_view one, std::string_view verb_of_one = {},
                    std::string_view verb_of_several = {});

// "12.345 +- 0.012"; only the value if it has no sigma.
std::string withSigma(double value, double sigma, std::string_view between = " +- ");

}  // namespace evical
