#include "core/recording/text/text_bytes.h"

#include "core/base/error.h"

#include <zlib.h>

#include <algorithm>
#include <array>

namespace evical {
namespace {

constexpr unsigned kBuffer_bytes = 1U << 17;
constexpr std::size_t kMaxAtOnce = std::size_t{1} << 30;  // zlib counts in int

// Place of the high byte in units of UTF-16 without a mark: the bytes there are 0, and the others are ASCII.
// -1 for other texts.
int highByteOf(std::string_view first_bytes) {
  constexpr std::size_t kFewest = 8;
  const auto all = [&](std::size_t from, auto is) {
    for (std::size_t i = from; i < first_bytes.size(); i += 2)
      if (!is(first_bytes[i])) return false;
    return true;
  };
  const auto is_zero = [](char c) { return c == '\0'; };
  const auto is_ascii = [](char c) { return (c >= ' ' && c <= '~') || c == '\t' || c == '\r' || c == '\n'; };
  if (first_bytes.size() < kFewest) return -1;
  for (const std::size_t high : {0U, 1U})
    if (all(high, is_zero) && all(1 - high, is_ascii)) return static_cast<int>(high);
  return -1;
}

std::uint64_t bytesOf(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  return error ? 0 : bytes;
}

}  // namespace

bool isGzip(std::string_view first_bytes) {
  return first_bytes.starts_with("\x1F\x8B");
}

std::string firstTextBytes(const std::filesystem::path& path, std::size_t count) {
  std::string bytes(count, '\0');
  bytes.resize(TextBytes(path).read(bytes.data(), count));
  return bytes;
}

void TextBytes::Closing::operator()(gzFile_s* file) const {
  gzclose(file);
}

// Files that are not packed are read unchanged. A byte order mark, or zeros, identify UTF-16.
TextBytes::TextBytes(const std::filesystem::path& path)
    : file_(gzopen(path.c_str(), "rb")),
      size_(bytesOf(path)),
      limit_(UnpackingLimit::ofText(path.string(), size_)) {
  if (!file_) throw badInput(path.string(), "the file cannot be opened", "Check its permissions");
  gzbuffer(file_.get(), kBuffer_bytes);
  std::array<char, 64> begin{};
  const std::string_view first(begin.data(), readUnpacked(begin.data(), begin.size()));
  const bool marked = first.starts_with("\xFF\xFE") || first.starts_with("\xFE\xFF");
  high_byte_ = !marked ? highByteOf(first) : first.front() == '\xFF' ? 1 : 0;
  gzseek(file_.get(), marked ? 2 : 0, SEEK_SET);
  damaged_ = false;
}

std::size_t TextBytes::read(char* bytes, std::size_t count) {
  if (high_byte_ < 0) return readUnpacked(bytes, count);
  while (utf8_.size() < count && addUtf16()) {
  }
  const std::size_t got = utf8_.copy(bytes, count);
  utf8_.erase(0, got);
  return got;
}

// Converts the next piece to UTF-8; false at the end.
bool TextBytes::addUtf16() {
  constexpr std::size_t kPiece_bytes = std::size_t{1} << 16;
  std::string piece(kPiece_bytes, '\0');
  piece.resize(readUnpacked(piece.data(), piece.size()));
  for (std::size_t i = 0; i + 1 < piece.size(); i += 2) {
    const auto high = static_cast<unsigned char>(piece[i + static_cast<std::size_t>(high_byte_)]),
               low = static_cast<unsigned char>(piece[i + 1 - static_cast<std::size_t>(high_byte_)]);
    const auto unit = static_cast<unsigned>(high << 8 | low);
    if (unit < 0x80) {
      utf8_ += static_cast<char>(unit);
    } else if (unit < 0x800) {
      utf8_ += {static_cast<char>(0xC0 | unit >> 6), static_cast<char>(0x80 | (unit & 0x3F))};
    } else if (unit < 0xD800 || unit > 0xDFFF) {
      utf8_ += {static_cast<char>(0xE0 | unit >> 12), static_cast<char>(0x80 | (unit >> 6 & 0x3F)),
                static_cast<char>(0x80 | (unit & 0x3F))};
    } else {
      utf8_ += '?';  // a character beyond those of numbers and names
    }
  }
  return !piece.empty();
}

std::size_t TextBytes::readUnpacked(char* bytes, std::size_t count) {
  std::size_t got = 0;
  while (got < count && !damaged_) {
    const int more =
        gzread(file_.get(), bytes + got, static_cast<unsigned>(std::min(count - got, kMaxAtOnce)));
    if (more > 0) got += static_cast<std::size_t>(more);
    if (growth_) limit_.setFileBytes(growth_->bytes());
    if (more > 0) limit_.add(static_cast<std::uint64_t>(more));
    int error = Z_OK;
    gzerror(file_.get(), &error);
    damaged_ = more < 0 || (error != Z_OK && error != Z_STREAM_END);
    if (more <= 0 && (got > 0 || damaged_ || !awaitMore())) break;
  }
  return got;
}

bool TextBytes::isPacked() const {
  return gzdirect(file_.get()) == 0;
}

bool TextBytes::awaitMore() {
  if (!growth_) return false;
  const std::uint64_t read = position();
  const std::uint64_t size = growth_->waitFor(read + 1);
  gzclearerr(file_.get());
  return size > read;
}

std::uint64_t TextBytes::position() const {
  const z_off_t at = gzoffset(file_.get());
  return at < 0 ? size_ : static_cast<std::uint64_t>(at);
}

}  // namespace evical
