// An output file that takes its name when it is whole.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace evical {

// A number's bytes in the machine's order, which is that of the files: little endian.
template <class Number>
std::string numberBytes(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

// Writes next to `path`, under another name that begins with `path`'s; finish() writes it to the disk and
// renames it, the destructor removes it if finish() was not reached. Of several that write to one path the
// last to finish stays, complete. All functions throw CalibrationError with path and reason: BadInput if
// something else than a file exists at `path`, otherwise CalibrationFailed.
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

  // Place of the content until then, for libraries that write it themselves.
  const std::filesystem::path& partPath() const { return part_path_; }

 private:
  [[noreturn]] void fail(const char* what);
  void close();

  std::filesystem::path path_, part_path_;
  std::FILE* file_ = nullptr;
  std::uint64_t size_ = 0;
};

}  // namespace evical
