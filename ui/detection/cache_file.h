// SPDX-License-Identifier: GPL-3.0-or-later
// A temporary file that disappears with this object, even after a crash of the program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace evical::ui {

class CacheFile {
 public:
  // Name of the content in messages ("events"), and advice for a full disk.
  struct Words {
    std::string content, room_advice;
  };

  // Throws CalibrationError if no file can be created in the folder.
  CacheFile(const std::filesystem::path& folder, Words words);
  ~CacheFile();
  CacheFile(const CacheFile&) = delete;
  CacheFile& operator=(const CacheFile&) = delete;

  // Thread-safe; read() needs the bytes to be written already. Throw CalibrationError if the disk is full or
  // the file is too short.
  void write(const void* bytes, std::size_t count, std::uint64_t position);
  void read(void* bytes, std::size_t count, std::uint64_t position) const;

 private:
  std::filesystem::path folder_;
  Words words_;
  int file_ = -1;
};

}  // namespace evical::ui
