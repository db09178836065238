#include "core/recording/text/text_lines.h"

#include "core/base/time.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

namespace evical {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 18;

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}
bool isSeparator(char c) {
  return c == ' ' || c == ',' || c == '\t' || c == '\r' || c == ';';
}

}  // namespace

char lineEndOf(std::string_view first_bytes) {
  const bool has_newline = first_bytes.find('\n') != std::string_view::npos;
  return !has_newline && first_bytes.find('\r') != std::string_view::npos ? '\r' : '\n';
}

TextLines::TextLines(const std::filesystem::path& path) : file_(path), buffer_(kBufferBytes, '\0') {
  refill();
  line_end_ = lineEndOf({buffer_.data(), end_});
}

bool TextLines::refill() {
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  const std::size_t wanted = buffer_.size() - end_, got = file_.read(buffer_.data() + end_, wanted);
  end_ += got;
  ended_ = got < wanted;
  return got > 0;
}

bool TextLines::next(std::string_view& line) {
  const auto newline = [this] {
    return static_cast<const char*>(std::memchr(buffer_.data() + begin_, line_end_, end_ - begin_));
  };
  const char* found = newline();
  if (!found && refill()) found = newline();
  if (begin_ == end_) return false;
  const char* const start = buffer_.data() + begin_;
  const std::size_t length = found ? static_cast<std::size_t>(found - start) : end_ - begin_;
  line = {start, length};
  const std::size_t taken = found ? length + 1 : length;
  begin_ += taken;
  ++number_;
  return true;
}

std::string_view takeColumn(std::string_view& line) {
  std::size_t start = 0;
  while (start < line.size() && isSeparator(line[start])) ++start;
  std::size_t end = start;
  while (end < line.size() && !isSeparator(line[end])) ++end;
  const std::string_view column = line.substr(start, end - start);
  line.remove_prefix(end);
  return column;
}

bool parseSeconds(std::string_view text, std::int64_t& time_ns) {
  return parseTime(text, 9, time_ns);
}

bool parseTime(std::string_view text, int digits_of_unit, std::int64_t& time_ns) {
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  std::array<char, 40> digits{};
  std::size_t count = 0;
  long point = -1, i = 0;
  for (; i < static_cast<long>(text.size()); ++i) {
    const char c = text[static_cast<std::size_t>(i)];
    if (c == '.' && point < 0) {
      point = static_cast<long>(count);
    } else if (!isDigit(c) || count == digits.size()) {
      break;
    } else {
      digits[count++] = c;
    }
  }
  if (count == 0) return false;
  if (point < 0) point = static_cast<long>(count);
  text.remove_prefix(static_cast<std::size_t>(i));
  if (!text.empty()) {
    if (text[0] != 'e' && text[0] != 'E') return false;
    text.remove_prefix(text.size() > 1 && text[1] == '+' ? 2 : 1);
    int exponent = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), exponent);
    if (error != std::errc{} || end != text.data() + text.size() || exponent < -60 || exponent > 60)
      return false;
    point += exponent;
  }
  point += digits_of_unit - 9;
  constexpr std::int64_t kLargest = INT64_MAX / 10 - 1;
  const auto digit = [&](long at) {
    return at < 0 || at >= static_cast<long>(count) ? 0 : digits[static_cast<std::size_t>(at)] - '0';
  };
  std::int64_t value = 0;
  for (long at = std::min(0L, point); at < point + 9; ++at) {
    if (value > kLargest) return false;
    value = value * 10 + digit(at);
  }
  if (digit(point + 9) >= 5) ++value;
  time_ns = negative ? -value : value;
  return isTime(time_ns);
}

bool parseNumber(std::string_view text, double& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
}

bool parseNumber(std::string_view text, std::uint16_t& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace evical
