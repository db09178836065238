// Lines of a text file, read through a buffer of fixed size, and the numbers in them.
#pragma once

#include "core/recording/text/text_bytes.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace evical {

// Line end of a text that begins like this: a newline, or a carriage return if it has no newline.
char lineEndOf(std::string_view first_bytes);

class TextLines {
 public:
  explicit TextLines(const std::filesystem::path& path);

  // Next line without its end, valid until the next call; false at the end of the file. A line longer than
  // the buffer is returned in pieces.
  bool next(std::string_view& line);
  // For a file that is still being written: next() waits for whole lines.
  void follow(const std::shared_ptr<Growth>& growth);
  bool wouldWait() const;
  bool isPacked() const { return file_.isPacked(); }

  std::uint64_t number() const { return number_; }              // of the last line returned, from 1
  bool atEnd() const { return ended_ && begin_ == end_; }       // the last line was returned
  bool isDamaged() const { return file_.isDamaged(); }          // a packed file that ends too early
  std::uint64_t bytesRead() const { return file_.position(); }  // of the file on the disk, ahead of the lines
  std::uint64_t size() const { return file_.size(); }

 private:
  bool refill();
  const char* lineEnd() const;

  TextBytes file_;
  char line_end_ = '\n';
  std::string buffer_;
  std::size_t begin_ = 0, end_ = 0;  // unread part of the buffer
  bool ended_ = false, follows_ = false;
  std::uint64_t number_ = 0;
};

// Removes columns from a line's front; they are separated by blanks, tabs or commas. Empty
// at the end.
std::string_view takeColumn(std::string_view& line);

// Seconds to ns, exactly for up to 9 decimals, otherwise rounded; also with an exponent. False for other text
// or beyond 2^63 ns.
bool parseSeconds(std::string_view text, std::int64_t& time_ns);

// The same for times in units of 10^digits ns: 9 for seconds, 3 for us.
bool parseTime(std::string_view text, int digits, std::int64_t& time_ns);

// Digits of a unit of 10^digits ns.
int digitsOf(std::int64_t unit_ns);

// ISO 8601 date and time, "2026-03-01T10:00:00.25Z" or with a blank for the T, as ns since 1970; UTC without
// a zone. A date alone is its midnight.
bool parseDate(std::string_view text, std::int64_t& time_ns);

// Time of day, "12:34:56.789", also with a decimal comma, with AM or PM, or with ":789" for milliseconds, as
// ns since midnight.
bool parseClock(std::string_view text, std::int64_t& time_ns);

// A finite number; false otherwise.
bool parseNumber(std::string_view text, double& value);
bool parseNumber(std::string_view text, std::uint16_t& value);

}  // namespace evical
