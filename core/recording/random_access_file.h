// Random access to a file's bytes, read in large blocks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace evical {

class RandomAccessFile {
 public:
  // Throws CalibrationError (BadInput) if the file cannot be opened.
  explicit RandomAccessFile(const std::filesystem::path& path);

  std::uint64_t size() const { return size_; }  // at opening

  // Bytes, valid until the next call; false unless all of them exist.
  bool read(std::uint64_t position, std::uint64_t count, std::string_view& bytes);

 private:
  std::ifstream file_;
  std::uint64_t size_ = 0;
  std::string block_;
  std::uint64_t block_position_ = 0;
};

}  // namespace evical
