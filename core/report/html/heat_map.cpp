#include "core/report/html/heat_map.h"

#include "core/report/html/html_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical::html {

std::string heatMapSvg(const std::string& title, const std::vector<std::string>& names,
                       const Eigen::MatrixXd& values) {
  constexpr double kLargest_px = 860.0, kLetter_px = 7.2;
  const auto count = static_cast<double>(names.size());
  std::size_t longest = 0;
  for (const std::string& name : names) longest = std::max(longest, name.size());
  const double left = std::min(340.0, kLetter_px * static_cast<double>(longest) + 34.0), top = 8.0;
  const double cell = std::clamp((kLargest_px - left - 24.0) / count, 6.0, 22.0);
  const double width = left + cell * count + 24.0, height = top + cell * count + 26.0;
  std::string text =
      plotTitle(title) +
      fmt::format(
          "<svg viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" role=\"img\" "
          "aria-label=\"{2}\">\n",
          width, height, escaped(title));
  for (std::size_t row = 0; row < names.size(); ++row) {
    const double y = top + cell * static_cast<double>(row);
    text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{} {}</text>\n", left - 5.0,
                        y + 0.5 * cell + 4.0, escaped(names[row]), row + 1);
    if (cell > 14.0 || row % 5 == 4)
      text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                          left + cell * (static_cast<double>(row) + 0.5), height - 8.0, row + 1);
    for (std::size_t col = 0; col < names.size(); ++col) {
      const double value = values(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(col));
      if (!std::isfinite(value) || std::abs(value) < 0.02) continue;
      text += fmt::format(
          "<rect class=\"fill {}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
          "fill-opacity=\"{:.2f}\"><title>{} / {}: {}</title></rect>\n",
          value > 0.0 ? "warm" : "cold", left + cell * static_cast<double>(col), y, cell - 0.5, cell - 0.5,
          std::min(1.0, std::abs(value)), escaped(names[row]), escaped(names[col]), number(value, 2));
    }
  }
  return text + fmt::format(
                    "<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
                    "height=\"{:.1f}\"/>\n</svg>\n",
                    left, top, cell * count, cell * count);
}

}  // namespace evical::html
