#include "core/base/plain_text.h"

#include "core/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace evical {
namespace {

struct Character {
  std::size_t bytes = 1;
  std::optional<char32_t> code = {};  // nothing: this byte is not UTF-8
};

// The first character of a text that is not empty.
Character firstCharacter(std::string_view text) {
  constexpr char32_t kLast = 0x10FFFF, kSurrogates = 0xD800, kAfterSurrogates = 0xE000;
  constexpr char32_t kMin[] = {0, 0, 0x80, 0x800, 0x10000};  // by the number of bytes
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return {1, byte(0)};
  const std::size_t bytes = byte(0) >> 5 == 0x6 ? 2 : byte(0) >> 4 == 0xE ? 3 : byte(0) >> 3 == 0x1E ? 4 : 0;
  if (bytes == 0 || bytes > text.size()) return {};
  char32_t code = byte(0) & (0x7F >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if (byte(i) >> 6 != 0x2) return {};
    code = code << 6 | (byte(i) & 0x3F);
  }
  if (code < kMin[bytes] || code > kLast || (code >= kSurrogates && code < kAfterSurrogates)) return {};
  return {bytes, code};
}

bool isControl(char32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0) || (code >= 0x2028 && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069) || code == 0xFFFE || code == 0xFFFF;
}

template <class Visit>
void forEachCharacter(std::string_view text, Visit&& visit) {
  while (!text.empty()) {
    const Character first = firstCharacter(text);
    visit(text.substr(0, first.bytes), first.code);
    text.remove_prefix(first.bytes);
  }
}

std::string byteEscape(char byte) {
  return fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
}

std::string escaped(std::string_view text, std::string_view kept, bool other_bytes) {
  std::string shown;
  forEachCharacter(text, [&](std::string_view bytes, const std::optional<char32_t>& code) {
    const bool stays = code ? !isControl(*code) || kept.find(bytes) != std::string_view::npos : !other_bytes;
    if (stays)
      shown += bytes;
    else
      shown += code && *code >= 0x20 ? fmt::format("\\u{:04x}", static_cast<unsigned>(*code))
                                     : byteEscape(bytes[0]);
  });
  return shown;
}

}  // namespace

bool hasControl(std::string_view text) {
  bool found = false;
  forEachCharacter(text, [&](std::string_view, const std::optional<char32_t>& code) {
    found = found || (code && isControl(*code));
  });
  return found;
}

std::string visible(std::string_view text, std::string_view kept) {
  return escaped(text, kept, false);
}

std::string printable(std::string_view text) {
  return escaped(text, {}, true);
}

void requirePlain(std::string_view text, const std::string& place, const std::string& what) {
  if (hasControl(text))
    throw badInput(place, fmt::format("{} has a control character: '{}'", what, printable(text)),
                   "Remove the character");
}

}  // namespace evical
