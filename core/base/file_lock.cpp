#include "core/base/file_lock.h"

#include "core/base/error.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

namespace evical {

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
