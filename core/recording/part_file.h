// An output file that takes its name when it is whole.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string_view>

namespace evical {

// Writes to "<path>.part"; finish() renames it to `path`, the destructor removes it if finish() was not
// reached. Everything throws CalibrationError (CalibrationFailed) with path and reason.
class PartFile {
 public:
  explicit PartFile(std::filesystem::path path);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  void append(std::string_view bytes);
  void overwrite(std::uint64_t position,
                 std::string_view bytes);  // what is already written; then append again
  std::uint64_t size() const { return size_; }
  void finish();

 private:
  [[noreturn]] void fail(const char* what);
  void close();

  std::filesystem::path path_, part_path_;
  std::FILE* file_ = nullptr;
  std::uint64_t size_ = 0;
};

}  // namespace evical
