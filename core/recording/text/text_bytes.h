// Bytes of a text file from begin to end, unpacked if it is packed with gzip. UTF-16, as PowerShell and Excel
// write it, becomes UTF-8, also without a byte order mark.
#pragma once

#include "core/recording/live/growth.h"
#include "core/recording/unpacking_limit.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

struct gzFile_s;

namespace evical {

bool isGzip(std::string_view first_bytes);

// The first bytes, unpacked; fewer if the file is shorter or damaged.
std::string firstTextBytes(const std::filesystem::path& path, std::size_t count);

class TextBytes {
 public:
  // Throws CalibrationError (BadInput) if the file cannot be opened.
  explicit TextBytes(const std::filesystem::path& path);

  // Number of bytes read; 0 at the end, and if a packed file is damaged from here on. Throws CalibrationError
  // (BadInput) if it unpacks to more than a recording can.
  std::size_t read(char* bytes, std::size_t count);
  // From now on read() returns what there is, and waits only if there is nothing yet.
  void follow(std::shared_ptr<Growth> growth) { growth_ = std::move(growth); }
  bool isPacked() const;
  // A read would wait.
  bool isAhead() const { return growth_ && !growth_->hasEnded() && growth_->bytes() <= position(); }
  bool isDamaged() const { return damaged_; }  // a packed file ended too early

  // Size of the file on the disk.
  std::uint64_t size() const { return size_; }
  std::uint64_t position() const;

 private:
  struct Closing {
    void operator()(gzFile_s* file) const;
  };
  std::size_t readUnpacked(char* bytes, std::size_t count);
  bool awaitMore();
  bool addUtf16();

  std::unique_ptr<gzFile_s, Closing> file_;
  int high_byte_ = -1;  // of UTF-16: place of a unit's high byte; -1: not UTF-16
  std::string utf8_;    // converted, not yet read
  std::uint64_t size_ = 0;
  UnpackingLimit limit_;
  std::shared_ptr<Growth> growth_;
  bool damaged_ = false;
};

}  // namespace evical
