// Control characters in texts from files. They end lines, and so comments, of exported files, and operate
// terminals.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace evical {

// True if the text has a character below U+0020, U+007F to U+009F, or one of Unicode that ends a line
// (U+2028, U+2029), changes the direction of text (U+202A to U+202E, U+2066 to U+2069) or is none (U+FFFE,
// U+FFFF).
bool hasControl(std::string_view text);

// The text with these characters as escapes that JSON and YAML read, too: "\x1b" below U+0020, otherwise
// "\u2028". Those in `kept` stay.
std::string visible(std::string_view text, std::string_view kept = {});

// The same without exceptions, and bytes that are not UTF-8 as escapes, too: for readers that refuse them.
std::string printable(std::string_view text);

// Throws CalibrationError (BadInput) if the text has a control character; `what` is "the name", `place` a
// file or a key.
void requirePlain(std::string_view text, const std::string& place, const std::string& what);

// A text without blanks at both ends.

// `around`: the characters that count as blanks.
inline std::string_view trimmed(std::string_view text, std::string_view around = " \t\r") {
  const std::size_t begin = std::min(text.find_first_not_of(around), text.size());
  const std::size_t end = text.find_last_not_of(around);
  return end == std::string_view::npos ? std::string_view{} : text.substr(begin, end + 1 - begin);
}

// Quoting of a text as one word of a shell command, for commands that users copy.

// Unchanged if no quotes are needed, else in single quotes.
inline std::string shellWord(const std::string& text) {
  constexpr const char* kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=.,:/@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

}  // namespace evical
