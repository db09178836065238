#include "core/recording/part_file.h"

#include "core/base/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace evical {

PartFile::PartFile(std::filesystem::path path)
    : path_(std::move(path)), part_path_(path_.string() + ".part") {
  file_ = std::fopen(part_path_.c_str(), "wb");
  if (!file_) fail("cannot be created");
}

PartFile::~PartFile() {
  close();
}

void PartFile::append(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail("cannot be written");
  size_ += bytes.size();
}

void PartFile::overwrite(std::uint64_t position, std::string_view bytes) {
  const bool done = std::fseek(file_, static_cast<long>(position), SEEK_SET) == 0 &&
                    std::fwrite(bytes.data(), 1, bytes.size(), file_) == bytes.size() &&
                    std::fseek(file_, 0, SEEK_END) == 0;
  if (!done) fail("cannot be written");
}

void PartFile::finish() {
  // Buffered bytes meet a full disk only here.
  if (std::fflush(file_) != 0) fail("cannot be written");
  if (std::fclose(std::exchange(file_, nullptr)) != 0 ||
      std::rename(part_path_.c_str(), path_.c_str()) != 0) {
    const int reason = errno;
    std::remove(part_path_.c_str());
    errno = reason;
    fail("cannot be written");
  }
}

void PartFile::fail(const char* what) {
  const std::string reason = std::strerror(errno);
  close();
  throw calibrationFailed(path_.string(), fmt::format("the file {}: {}", what, reason),
                          "Check the folder, its permissions and the space on the disk");
}

void PartFile::close() {
  if (!file_) return;
  std::fclose(std::exchange(file_, nullptr));
  std::remove(part_path_.c_str());
}

}  // namespace evical
