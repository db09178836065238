#include "core/report/csv_text.h"

#include "core/base/plain_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
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

namespace {

// Parses a number; the whole text must be the number.
template <class Number>
bool parse(const std::string& word, Number& number) {
  const char* const end = word.data() + word.size();
  const auto [stopped_at, error] = std::from_chars(word.data(), end, number);
  return error == std::errc() && stopped_at == end;
}

}  // namespace

CsvReader::CsvReader(const std::filesystem::path& file, const std::vector<std::string>& columns)
    : file_(file), columns_(columns) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(file, ignored))  // opening a pipe waits for its other end
    stream_.open(file);
  else
    stream_.setstate(std::ios::failbit);
  if (!stream_) throw badInput(file.string(), "cannot be read", "Give the result folder of an earlier run");
  if (!next()) throw badInput(file.string(), "is empty", "Give the result folder of an earlier run");
  const std::vector<std::string> names = words_;
  std::string missing;
  for (const std::string& column : columns) {
    const auto found = std::find(names.begin(), names.end(), column);
    if (found == names.end()) missing += (missing.empty() ? "" : ", ") + column;
    places_.push_back(static_cast<std::size_t>(found - names.begin()));
  }
  if (!missing.empty())
    throw badInput(file.string(), "has no column " + missing,
                   "Detect again: an earlier version may have written the file");
}

bool CsvReader::next() {
  while (std::getline(stream_, line_)) {
    ++number_;
    if (line_.ends_with('\r')) line_.pop_back();
    if (line_.empty()) continue;
    const std::size_t count = words_.size();
    if (!split() || (!places_.empty() && words_.size() != count))
      throw badInput(fmt::format("{} (line {})", file_.string(), number_),
                     fmt::format("has {} columns instead of {}", words_.size(), count),
                     "The file is damaged: detect again");
    return true;
  }
  return false;
}

// Text with commas is in quotes; quotes in it are doubled.
bool CsvReader::split() {
  words_.assign(1, {});
  bool quoted = false;
  for (std::size_t k = 0; k < line_.size(); ++k) {
    const char c = line_[k];
    if (c == '"' && quoted && k + 1 < line_.size() && line_[k + 1] == '"')
      words_.back() += line_[++k];
    else if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      words_.emplace_back();
    else
      words_.back() += c;
  }
  for (std::string& word : words_) word = fromCsv(word);
  return !quoted;
}

CalibrationError CsvReader::error(std::size_t column, const std::string& problem) const {
  return badInput(fmt::format("{} (line {})", file_.string(), number_),
                  fmt::format("{} '{}' {}", columns_[column], text(column), problem),
                  "The file is damaged: detect again");
}

double CsvReader::real(std::size_t column) const {
  double number = 0.0;
  if (!parse(text(column), number) || !std::isfinite(number)) throw error(column, "is not a number");
  return number;
}

int CsvReader::integer(std::size_t column, int minimum, int maximum) const {
  int number = 0;
  if (!parse(text(column), number) || number < minimum || number > maximum)
    throw error(column, fmt::format("is not in {}..{}", minimum, maximum));
  return number;
}

std::size_t CsvReader::choice(std::size_t column, const std::vector<std::string_view>& words) const {
  const auto found = std::find(words.begin(), words.end(), text(column));
  if (found == words.end()) throw error(column, "is unknown");
  return static_cast<std::size_t>(found - words.begin());
}

}  // namespace evical
