// A large file that appears whole or not at all: written aside under another name, renamed at the end,
// removed if that end is never reached. For small ones core/base/atomic_file.h is simpler.
#pragma once

#include "core/recording/byte_reader.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

class OutputFile {
 public:
  // All members throw CalibrationError (CalibrationFailed) that names path and reason.
  explicit OutputFile(const std::filesystem::path& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return written_ + buffer_.size(); }

  void append(Bytes bytes);
  void append(std::string_view text) { append(bytesOf(text)); }
  void overwrite(std::uint64_t position, Bytes bytes);  // within size()

  // Syncs, and closes; then rename() makes the file appear under its name. Two steps, so that files which
  // belong together are all safe on the disk before the first of them appears.
  void close();
  void rename();

 private:
  void flush();
  void writeAt(std::uint64_t position, Bytes bytes);

  std::filesystem::path path_;
  std::string aside_;
  int file_ = -1;
  std::uint64_t written_ = 0;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace evical
