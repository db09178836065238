// A file opened for reading at any place, without mapping: a file that shrinks while it is read gives short
// reads, not a crash, and its pages do not count as our memory.
#pragma once

#include "core/recording/byte_reader.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace evical {

class InputFile {
 public:
  // Throws CalibrationError (BadInput) if there is no such file or it can't be opened.
  explicit InputFile(const std::filesystem::path& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }

  // Fills `buffer` with up to `count` bytes from `offset`: fewer at the file's end or where the disk fails.
  // Never allocates more than the file holds from there.
  void readAt(std::uint64_t offset, std::uint64_t count, std::vector<std::uint8_t>& buffer) const;

 private:
  std::filesystem::path path_;
  int file_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace evical
