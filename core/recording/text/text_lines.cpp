#include "core/recording/text/text_lines.h"

#include "core/base/number.h"
#include "core/base/time.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
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
  ended_ = follows_ ? got == 0 : got < wanted;
  return got > 0;
}

const char* TextLines::lineEnd() const {
  return static_cast<const char*>(std::memchr(buffer_.data() + begin_, line_end_, end_ - begin_));
}

void TextLines::follow(const std::shared_ptr<Growth>& growth) {
  file_.follow(growth);
  follows_ = true;
}

bool TextLines::wouldWait() const {
  return follows_ && lineEnd() == nullptr && file_.isAhead();
}

bool TextLines::next(std::string_view& line) {
  const char* found = lineEnd();
  while (!found && end_ - begin_ < buffer_.size() && refill()) found = lineEnd();
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

int digitsOf(std::int64_t unit_ns) {
  int digits = 0;
  for (; unit_ns >= 10; unit_ns /= 10) ++digits;
  return digits;
}

bool parseDate(std::string_view text, std::int64_t& time_ns) {
  // "2026-03-01T10:00:00"
  constexpr std::size_t kSeconds = 17, kDate = 10;
  constexpr std::string_view kMidnight = "T00:00:00";
  if (text.size() == kDate) {
    std::array<char, kDate + kMidnight.size()> whole{};
    std::ranges::copy(kMidnight, std::ranges::copy(text, whole.begin()).out);
    return parseDate({whole.data(), whole.size()}, time_ns);
  }
  if (text.size() < kSeconds + 2 || (text[4] != '-' && text[4] != '/' && text[4] != '.') ||
      text[7] != text[4] || (text[10] != 'T' && text[10] != ' ') || text[13] != ':' || text[16] != ':')
    return false;
  const auto number = [&](std::size_t at, std::size_t length, int least, int most) {
    int value = -1;
    const char* const end = text.data() + at + length;
    const auto result = std::from_chars(text.data() + at, end, value);
    return result.ec == std::errc{} && result.ptr == end && value >= least && value <= most ? value : -1;
  };
  const int year = number(0, 4, 1970, 2100), month = number(5, 2, 1, 12), day = number(8, 2, 1, 31);
  const int hour = number(11, 2, 0, 23), minute = number(14, 2, 0, 59);
  std::string_view rest = text.substr(kSeconds);
  const std::size_t zone = std::min(rest.find_first_of("Z+-"), rest.size());
  std::int64_t seconds_ns = 0, zone_minutes = 0;
  if (std::min({year, month, day, hour, minute}) < 0 || !parseSeconds(rest.substr(0, zone), seconds_ns))
    return false;
  rest.remove_prefix(zone);
  if (rest.size() == 6 && rest[3] == ':') {  // "+01:00"
    const std::size_t at = text.size() - rest.size();
    const int hours = number(at + 1, 2, 0, 23), minutes = number(at + 4, 2, 0, 59);
    if (hours < 0 || minutes < 0) return false;
    zone_minutes = (rest[0] == '-' ? -1 : 1) * (60 * hours + minutes);
  } else if (!rest.empty() && rest != "Z") {
    return false;
  }
  const std::chrono::year_month_day date(std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day)));
  if (!date.ok()) return false;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  time_ns = (((days * 24 + hour) * 60 + minute - zone_minutes) * 60) * kSecond_ns + seconds_ns;
  return true;
}

bool parseClock(std::string_view text, std::int64_t& time_ns) {
  std::string_view rest = text;
  const auto number = [&](int most, char end) {
    int value = -1;
    const auto [stop, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    const auto length = static_cast<std::size_t>(stop - rest.data());
    if (error != std::errc{} || length > 2 || value < 0 || value > most || length >= rest.size() ||
        rest[length] != end)
      return -1;
    rest.remove_prefix(length + 1);
    return value;
  };
  const auto takeEnd = [&](std::string_view upper, std::string_view lower) {
    const bool has = rest.ends_with(upper) || rest.ends_with(lower);
    if (has) rest.remove_suffix(upper.size());
    while (has && rest.ends_with(' ')) rest.remove_suffix(1);
    return has;
  };
  const bool evening = takeEnd("PM", "pm"), morning = !evening && takeEnd("AM", "am");
  int hours = number(23, ':');
  const int minutes = number(59, ':');
  if (hours < 0 || minutes < 0 || rest.empty() || rest.size() > 16 || !isDigit(rest.front())) return false;
  if (evening || morning) {
    if (hours == 0 || hours > 12) return false;
    hours = hours % 12 + (evening ? 12 : 0);
  }
  std::array<char, 16> seconds{};  // "56,789" and "56:789" become "56.789"
  std::replace_copy_if(
      rest.begin(), rest.end(), seconds.begin(), [](char c) { return c == ',' || c == ':'; }, '.');
  const std::string_view plain(seconds.data(), rest.size());
  std::int64_t seconds_ns = 0;
  const bool digits = plain.find_first_not_of("0123456789.") == std::string_view::npos &&
                      std::min(plain.find('.'), plain.size()) <= 2;
  if (!digits || !parseSeconds(plain, seconds_ns) || seconds_ns > 61 * kSecond_ns) return false;
  time_ns = (hours * 60 + minutes) * 60 * kSecond_ns + seconds_ns;
  return true;
}

bool parseNumber(std::string_view text, double& value) {
  const std::optional<double> number = realFrom(text);
  if (number) value = *number;
  return number.has_value();
}

bool parseNumber(std::string_view text, std::uint16_t& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace evical
