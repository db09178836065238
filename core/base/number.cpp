#include "core/base/number.h"

#include <fmt/format.h>

#include <algorithm>

namespace evical {

int decimalsFor(double sigma, int most, int without) {
  if (!(sigma > 0.0) || !std::isfinite(sigma)) return without;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(sigma))), 0, most);
}

std::string withSigma(double value, double sigma, std::string_view between) {
  if (!(sigma > 0.0) || !std::isfinite(sigma)) return fmt::format("{:.6g}", value);
  const int decimals = decimalsFor(sigma);
  return fmt::format("{:.{}f}{}{:.{}f}", value, decimals, between, sigma, decimals);
}

}  // namespace evical
