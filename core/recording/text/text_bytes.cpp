#include "core/recording/text/text_bytes.h"

#include "core/base/error.h"

#include <zlib.h>

#include <algorithm>

namespace evical {
namespace {

constexpr unsigned kBuffer_bytes = 1U << 17;
constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;  // zlib counts in int

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

// Files that are not packed are read unchanged.
TextBytes::TextBytes(const std::filesystem::path& path) : file_(gzopen(path.c_str(), "rb")) {
  if (!file_) throw badInput(path.string(), "the file cannot be opened", "Check its permissions");
  gzbuffer(file_.get(), kBuffer_bytes);
  size_ = std::filesystem::file_size(path);
}

std::size_t TextBytes::read(char* bytes, std::size_t count) {
  std::size_t got = 0;
  while (got < count && !damaged_) {
    const int more =
        gzread(file_.get(), bytes + got, static_cast<unsigned>(std::min(count - got, kMostAtOnce)));
    if (more > 0) got += static_cast<std::size_t>(more);
    int error = Z_OK;
    gzerror(file_.get(), &error);
    damaged_ = more < 0 || (error != Z_OK && error != Z_STREAM_END);
    if (more <= 0) break;
  }
  return got;
}

std::uint64_t TextBytes::position() const {
  const z_off_t at = gzoffset(file_.get());
  return at < 0 ? size_ : static_cast<std::uint64_t>(at);
}

}  // namespace evical
