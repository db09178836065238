#include "core/recording/input_file.h"

#include "core/base/error.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace evical {

InputFile::InputFile(const std::filesystem::path& path) : path_(path) {
  file_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file_ < 0) {
    const std::string reason = std::strerror(errno);
    throw badInput(path.string(), "cannot be opened: " + reason,
                   "Check the path and your permission to read it");
  }
  struct stat status = {};
  if (::fstat(file_, &status) == 0 && S_ISREG(status.st_mode)) {
    size_ = static_cast<std::uint64_t>(status.st_size);
    return;
  }
  ::close(file_);
  throw badInput(path.string(), "is not a regular file", "Give the recording itself");
}

InputFile::~InputFile() {
  ::close(file_);
}

void InputFile::readAt(std::uint64_t offset, std::uint64_t count, std::vector<std::uint8_t>& buffer) const {
  const std::uint64_t available = offset < size_ ? size_ - offset : 0;
  buffer.resize(static_cast<std::size_t>(std::min(count, available)));
  std::size_t filled = 0;
  while (filled < buffer.size()) {
    const ssize_t got =
        ::pread(file_, buffer.data() + filled, buffer.size() - filled, static_cast<off_t>(offset + filled));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    filled += static_cast<std::size_t>(got);
  }
  buffer.resize(filled);
}

}  // namespace evical
