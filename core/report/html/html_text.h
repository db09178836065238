// Text and numbers for HTML, SVG and CSV: escaped, and never "nan" or "inf".
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace evical::html {

inline constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

// Escapes text and attributes in double quotes; control characters that XML does not allow become '?'.
std::string escaped(std::string_view text);

// Fixed decimals; a dash if the value is not finite.
std::string number(double value, int decimals);
// About `digits` significant digits, without an exponent if the text stays short.
std::string significant(double value, int digits = 3);
// Shortest text of a given number: "0.1", "20".
std::string plain(double value);
// "12.345 ± 0.012": as many decimals as the sigma's second digit; sigma 0 or unknown: the value alone.
std::string withSigma(double value, double sigma, int max_decimals = 6);

std::string element(std::string_view tag, std::string_view css_class, std::string_view content);
std::string paragraph(std::string_view css_class, std::string_view escaped_text);

// Title above a plot.
std::string plotTitle(std::string_view title);

// A table with a header line; cells are HTML already.
std::string table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);

}  // namespace evical::html
