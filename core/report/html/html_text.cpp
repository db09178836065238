#include "core/report/html/html_text.h"

#include "core/base/number.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical::html {
namespace {

constexpr const char* kNothing = "\u2013";

std::string signedText(std::string text) {
  const bool zero = text.find_first_of("123456789") == std::string::npos;
  if (text.front() == '-') text = (zero ? "" : "\u2212") + text.substr(1);
  return text;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' ? '?' : c;
    }
  }
  return safe;
}

std::string number(double value, int decimals) {
  return std::isfinite(value) ? signedText(fmt::format("{:.{}f}", value, decimals)) : kNothing;
}

std::string significant(double value, int digits) {
  if (!std::isfinite(value)) return kNothing;
  if (value == 0.0) return "0";
  const double size = std::abs(value);
  if (size < 1e-4 || size >= 1e6) return signedText(fmt::format("{:.{}e}", value, digits - 1));
  const int whole_digits = static_cast<int>(std::floor(std::log10(size))) + 1;
  return number(value, std::max(0, digits - whole_digits));
}

std::string plain(double value) {
  return std::isfinite(value) ? signedText(fmt::format("{:.4g}", value)) : kNothing;
}

std::string withSigma(double value, double sigma, int max_decimals) {
  const int decimals = decimalsFor(sigma, max_decimals, std::min(max_decimals, 4));
  if (!std::isfinite(sigma) || !(sigma > 0.0)) return number(value, decimals);
  return fmt::format("{} <span class=\"pm\">\u00b1 {}</span>", number(value, decimals),
                     number(sigma, decimals));
}

std::string element(std::string_view tag, std::string_view css_class, std::string_view content) {
  const std::string attribute = css_class.empty() ? "" : fmt::format(" class=\"{}\"", css_class);
  return fmt::format("<{0}{1}>{2}</{0}>\n", tag, attribute, content);
}

std::string paragraph(std::string_view css_class, std::string_view escaped_text) {
  return element("p", css_class, escaped_text);
}

std::string plotTitle(std::string_view title) {
  std::string text(title);
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return element("div", "title", escaped(text));
}

std::string table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
  std::string text = "<div class=\"wide\"><table>\n<thead><tr>";
  for (const std::string& cell : header) text += "<th>" + cell + "</th>";
  text += "</tr></thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : rows) {
    text += "<tr>";
    for (const std::string& cell : row) text += "<td>" + cell + "</td>";
    text += "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

}  // namespace evical::html
