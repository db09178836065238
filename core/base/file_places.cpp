#include "core/base/file_places.h"

#include "core/base/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

namespace evical {

CalibrationError writeError(const std::filesystem::path& path, int error) {
  return calibrationFailed(path.string(), fmt::format("cannot be written: {}", std::strerror(error)),
                           error == ENOSPC ? "Free disk space, or choose another folder"
                                           : "Check that the folder exists and has write permission");
}

int whyNoPlace(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (std::filesystem::is_directory(status)) return EISDIR;
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) ? EEXIST : 0;
}

std::string contentOfFile(const std::filesystem::path& file, std::uintmax_t max_bytes) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  std::string bytes(error ? 0 : std::min(size, max_bytes), '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

FileLock::FileLock(const std::filesystem::path& file) {
  constexpr mode_t kWritableByOwner = 0644;
  descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, kWritableByOwner);
  if (descriptor_ < 0)
    throw calibrationFailed(file.string(), std::string("cannot be created: ") + std::strerror(errno),
                            "Check the folder's permissions and the free disk space");
  tryAgain();
}

FileLock::FileLock(FileLock&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), taken_(std::exchange(other.taken_, false)) {}

FileLock::~FileLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool FileLock::tryAgain() {
  if (!taken_) taken_ = ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
  return taken_;
}

}  // namespace evical
