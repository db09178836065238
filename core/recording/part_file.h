// An output file that gets its name when it is complete.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace evical {

// A number's bytes in the machine's byte order, which is that of the files: little endian.
template <class Number>
std::string numberBytes(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

// Writes next to `path`, under another name that begins with `path`'s; finish() flushes it to the disk and
// renames it, the destructor removes it without finish(). If several write to one path, the last one to
// finish remains, complete. All functions throw CalibrationError with path and reason: BadInput if something
// other than a file exists at `path`, otherwise CalibrationFailed.
class PartFile {
 public:
  explicit PartFile(std::filesystem::path path);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  void append(std::string_view bytes);
  void overwrite(std::uint64_t position,
                 std::string_view bytes);  // replaces written bytes; append() continues at the end
  std::uint64_t size() const { return size_; }
  void finish();

  // Path of the content until then, for libraries that write it themselves.
  const std::filesystem::path& partPath() const { return part_path_; }

 private:
  [[noreturn]] void fail(const char* what);
  void close();

  std::filesystem::path path_, part_path_;
  std::FILE* file_ = nullptr;
  std::uint64_t size_ = 0;
};

}  // namespace evical
