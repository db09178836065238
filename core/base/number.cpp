#include "core/base/number.h"

#include <fmt/format.h>

#include <algorithm>

namespace evical {

int decimalsFor(double sigma, int most, int without) {
  if (!(sigma > 0.0) || !std::isfinite(sigma)) return without;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(sigma))), 0, most);
}

std::string counted(std::uint64_t count, std::string_view one, std::string_view verb_of_one,
                    std::string_view verb_of_several) {
  const std::string_view verb = count == 1 ? verb_of_one : verb_of_several;
  return fmt::format("{} {}{}{}{}", count, one, count == 1 ? "" : "s", verb.empty() ? "" : " ", verb);
}

std::string withSigma(double value, double sigma, std::string_view between) {
  if (!(sigma > 0.0) || !std::isfinite(sigma)) return fmt::format("{:.6g}", value);
  const int decimals = decimalsFor(sigma);
  return fmt::format("{:.{}f}{}{:.{}f}", value, decimals, between, sigma, decimals);
}

}  // namespace evical
