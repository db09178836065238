// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/cache_file.h"

#include "core/base/error.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

namespace evical::ui {

CacheFile::CacheFile(const std::filesystem::path& folder, Words words)
    : folder_(folder), words_(std::move(words)) {
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  std::string path = (folder / "evical_cache_XXXXXX").string();
  file_ = mkostemp(path.data(), O_CLOEXEC);
  if (file_ < 0) {
    throw badInput(folder.string(), std::string("no temporary file can be created: ") + std::strerror(errno),
                   "Make the folder writable");
  }
  unlink(path.c_str());  // the file itself lives until it is closed
}

CacheFile::~CacheFile() {
  close(file_);
}

void CacheFile::write(const void* bytes, std::size_t count, std::uint64_t position) {
  const auto* next = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t done = pwrite(file_, next, count, static_cast<off_t>(position));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) {
      throw calibrationFailed(folder_.string(), words_.content + " cannot be cached: " + std::strerror(errno),
                              words_.room_advice);
    }
    next += done;
    position += static_cast<std::uint64_t>(done);
    count -= static_cast<std::size_t>(done);
  }
}

void CacheFile::read(void* bytes, std::size_t count, std::uint64_t position) const {
  auto* next = static_cast<char*>(bytes);
  while (count > 0) {
    const ssize_t done = pread(file_, next, count, static_cast<off_t>(position));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0)
      throw calibrationFailed(folder_.string(), "cached " + words_.content + " cannot be read",
                              "Open the session again");
    next += done;
    position += static_cast<std::uint64_t>(done);
    count -= static_cast<std::size_t>(done);
  }
}

}  // namespace evical::ui
