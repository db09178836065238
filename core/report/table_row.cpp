#include "core/report/table_row.h"

#include "core/base/number.h"

#include <fmt/format.h>

namespace evical {

std::string tableRow(const std::string& name, double value, double sigma, const char* unit, int most) {
  const int decimals = decimalsFor(sigma, most, most);
  const std::string shown =
      sigma > 0.0 ? fmt::format("+- {:<10.{}f}", sigma, decimals) : std::string(13, ' ');
  return fmt::format("    {:<26}{:>12.{}f} {} {}\n", name, value, decimals, shown, unit);
}

}  // namespace evical
