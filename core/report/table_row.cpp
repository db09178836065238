#include "core/report/table_row.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

// "  0.0730 +- 0.0001": as many decimals as the sigma's second digit, at most what `most` says.
std::string withSigma(double value, double sigma, int most) {
  int decimals = most;
  if (std::isfinite(sigma) && sigma > 0.0)
    decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(sigma))), 0, most);
  if (!(sigma > 0.0)) return fmt::format("{:>12.{}f}              ", value, decimals);
  return fmt::format("{:>12.{}f} +- {:<10.{}f}", value, decimals, sigma, decimals);
}

}  // namespace

std::string tableRow(const std::string& name, double value, double sigma, const char* unit, int decimals) {
  return fmt::format("    {:<26}{} {}\n", name, withSigma(value, sigma, decimals), unit);
}

}  // namespace evical
