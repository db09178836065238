// SPDX-License-Identifier: GPL-3.0-or-later
// A temporary file that is gone when this object is, whatever becomes of the program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace evical::ui {

class CacheFile {
 public:
  // What is kept in it, as messages call it ("events"), and what to do where there is no room.
  struct Words {
    std::string content, room_advice;
  };

  // Throws CalibrationError if there can be no file in the folder.
  CacheFile(const std::filesystem::path& folder, Words words);
  ~CacheFile();
  CacheFile(const CacheFile&) = delete;
  CacheFile& operator=(const CacheFile&) = delete;

  // Any thread; of what was written before. Throw CalibrationError if the disk is full, or the file has no more.
  void write(const void* bytes, std::size_t count, std::uint64_t position);
  void read(void* bytes, std::size_t count, std::uint64_t position) const;

 private:
  std::filesystem::path folder_;
  Words words_;
  int file_ = -1;
};

}  // namespace evical::ui
