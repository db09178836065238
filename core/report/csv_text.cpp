#include "core/report/csv_text.h"

#include "core/base/plain_text.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <system_error>

namespace evical {
namespace {

// Beginnings of formulas, the last four of full width, and the mark itself.
constexpr std::string_view kBeginnings[] = {"=", "+", "-", "@", "'", "\uff1d", "\uff0b", "\uff0d", "\uff20"};
constexpr char kMark = '\'';

bool beginsFormula(std::string_view text) {
  return std::any_of(std::begin(kBeginnings), std::end(kBeginnings),
                     [text](std::string_view each) { return text.starts_with(each); });
}

bool isNumber(std::string_view text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stopped_at, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stopped_at == end;
}

std::string withMark(const std::string& text) {
  std::string line = text;
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  line = visible(line);
  return beginsFormula(line) && !isNumber(line) ? kMark + line : line;
}

}  // namespace

std::string quotedCsv(const std::string& text) {
  std::string safe = "\"";
  for (const char c : withMark(text)) {
    if (c == '"') safe += '"';
    safe += c;
  }
  return safe + "\"";
}

std::string csvWord(const std::string& text) {
  return text.find_first_of(",;\"\n\r") == std::string::npos ? withMark(text) : quotedCsv(text);
}

std::string fromCsv(const std::string& cell) {
  return cell.starts_with(kMark) && beginsFormula(std::string_view(cell).substr(1)) ? cell.substr(1) : cell;
}

}  // namespace evical
