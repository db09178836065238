#include "core/recording/random_access_file.h"

#include "core/base/error.h"

#include <algorithm>

namespace evical {
namespace {

constexpr std::uint64_t kCachedBlock_bytes = 1 << 20;

}  // namespace

RandomAccessFile::RandomAccessFile(const std::filesystem::path& path) {
  file_.rdbuf()->pubsetbuf(nullptr, 0);  // the block is the buffer
  file_.open(path, std::ios::binary | std::ios::ate);
  if (!file_) throw badInput(path.string(), "the file cannot be opened", "Check its permissions");
  size_ = static_cast<std::uint64_t>(file_.tellg());
}

bool RandomAccessFile::read(std::uint64_t position, std::uint64_t count, std::string_view& bytes) {
  if (position > size_ || count > size_ - position) return false;
  const bool is_there = position >= block_position_ && position + count <= block_position_ + block_.size();
  if (!is_there) {
    block_.resize(static_cast<std::size_t>(std::max(count, std::min(kCachedBlock_bytes, size_ - position))));
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(position));
    file_.read(block_.data(), static_cast<std::streamsize>(block_.size()));
    block_.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file_.gcount())));
    block_position_ = position;
    if (block_.size() < count) return false;
  }
  bytes = std::string_view(block_).substr(static_cast<std::size_t>(position - block_position_),
                                          static_cast<std::size_t>(count));
  return true;
}

}  // namespace evical
