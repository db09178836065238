#include "core/recording/text_table.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <limits>

namespace evical {
namespace {

constexpr std::size_t kBlockSize = 1U << 20;
constexpr std::size_t kLongestLine = 1U
                                     << 16;  // a longer one is no table; it comes in pieces, each malformed

bool isDigit(char character) {
  return character >= '0' && character <= '9';
}
bool isSeparator(char character) {
  return character == ' ' || character == '\t' || character == ',' || character == ';' || character == '\r';
}

// mantissa * 10^exponent, rounded half away from zero.
bool scaled(std::uint64_t mantissa, int exponent, bool negative, std::int64_t& value) {
  constexpr std::uint64_t kLimit = std::numeric_limits<std::int64_t>::max();
  if (mantissa == 0) exponent = 0;
  for (; exponent > 0; --exponent) {
    if (mantissa > kLimit / 10) return false;
    mantissa *= 10;
  }
  std::uint64_t last_digit = 0;
  for (; exponent < 0; ++exponent) {
    last_digit = mantissa % 10;
    mantissa /= 10;
    if (mantissa == 0 && exponent < -1) last_digit = 0, exponent = -1;
  }
  mantissa += last_digit >= 5 ? 1 : 0;
  if (mantissa > kLimit) return false;
  value = negative ? -static_cast<std::int64_t>(mantissa) : static_cast<std::int64_t>(mantissa);
  return true;
}

}  // namespace

// Keeps the beginning of a line that the block cuts.
bool LineReader::readBlock() {
  const std::size_t kept = block_.size() - position_;
  std::memmove(block_.data(), block_.data() + position_, kept);
  position_ = 0;
  file_.readAt(next_read_, kBlockSize, piece_);
  block_.resize(kept);
  block_.insert(block_.end(), piece_.begin(), piece_.end());
  next_read_ += piece_.size();
  return !piece_.empty();
}

bool LineReader::next(std::string_view& line) {
  const auto lineEnd = [&] {
    const std::size_t available = block_.size() - position_;
    return available > 0 ? std::memchr(block_.data() + position_, '\n', available) : nullptr;
  };
  const void* end = lineEnd();
  while (end == nullptr && block_.size() - position_ < kLongestLine && readBlock()) end = lineEnd();
  const std::size_t available = block_.size() - position_;
  if (available == 0) return false;
  const std::uint8_t* begin = block_.data() + position_;
  const std::size_t length = end != nullptr
                                 ? static_cast<std::size_t>(static_cast<const std::uint8_t*>(end) - begin)
                                 : std::min(available, kLongestLine);
  line = {reinterpret_cast<const char*>(begin), length};
  position_ += length + (end != nullptr ? 1 : 0);
  ++line_number_;
  return true;
}

double LineReader::fractionRead() const {
  const std::uint64_t read = next_read_ - (block_.size() - position_);
  return file_.size() > 0 ? static_cast<double>(read) / static_cast<double>(file_.size()) : 1.0;
}

void ColumnParser::skipSeparators() {
  std::size_t count = 0;
  while (count < text_.size() && isSeparator(text_[count])) ++count;
  text_.remove_prefix(count);
}

bool ColumnParser::atEnd() {
  skipSeparators();
  return text_.empty();
}

std::string_view ColumnParser::word() {
  skipSeparators();
  std::size_t count = 0;
  while (count < text_.size() && !isSeparator(text_[count])) ++count;
  const std::string_view result = text_.substr(0, count);
  text_.remove_prefix(count);
  return result;
}

bool ColumnParser::decimal(int power, std::int64_t& value) {
  skipSeparators();
  const char* at = text_.data();
  const char* const end = at + text_.size();
  const bool negative = at != end && *at == '-';
  if (at != end && (*at == '-' || *at == '+')) ++at;
  std::uint64_t mantissa = 0;
  int exponent = power;
  bool any_digit = false, after_point = false;
  for (; at != end; ++at) {
    if (*at == '.' && !after_point) {
      after_point = true;
      continue;
    }
    if (!isDigit(*at)) break;
    any_digit = true;
    if (mantissa < 1'000'000'000'000'000'000U) {
      mantissa = 10 * mantissa + static_cast<std::uint64_t>(*at - '0');
      exponent -= after_point ? 1 : 0;
    } else if (!after_point) {
      ++exponent;  // 19 digits are all that a result can hold
    }
  }
  if (!any_digit) return false;
  if (at != end && (*at == 'e' || *at == 'E')) {
    int shift = 0;
    const char* digits = at + 1 != end && at[1] == '+' ? at + 2 : at + 1;
    const auto [rest, error] = std::from_chars(digits, end, shift);
    if (error != std::errc() || shift < -400 || shift > 400) return false;
    exponent += shift;
    at = rest;
  }
  if (at != end && !isSeparator(*at)) return false;
  text_.remove_prefix(static_cast<std::size_t>(at - text_.data()));
  return scaled(mantissa, exponent, negative, value);
}

bool ColumnParser::real(double& value) {
  skipSeparators();
  if (!text_.empty() && text_.front() == '+') text_.remove_prefix(1);
  const auto [rest, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
  if (error != std::errc()) return false;
  const auto length = static_cast<std::size_t>(rest - text_.data());
  if (length < text_.size() && !isSeparator(text_[length])) return false;
  text_.remove_prefix(length);
  return true;
}

}  // namespace evical
