// Checks of paths and their error messages, and the content of files.
#pragma once

#include "core/base/atomic_file.h"
#include "core/base/error.h"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <system_error>

namespace evical {

// The error that this path cannot be written; `error` is an errno.
CalibrationError writeError(const std::filesystem::path& path, int error);

// Why this path cannot be replaced, as an errno; 0 if it can. A rename would replace a device or a pipe.
int whyNoPlace(const std::filesystem::path& path);

// True if the path exists, false if it does not or cannot be examined.
inline bool pathExists(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

// Content of a file, or its first bytes; empty if it cannot be read. A pipe or device has none: opening it
// could wait forever.
std::string contentOfFile(const std::filesystem::path& file,
                          std::uintmax_t max_bytes = std::numeric_limits<std::uintmax_t>::max());

// A folder that is created for results, and removed if it stays empty.
class NewFolder {
 public:
  // Throws CalibrationError (BadInput) if it cannot be created or written to.
  explicit NewFolder(const std::filesystem::path& folder) : folder_(folder), was_there_(pathExists(folder)) {
    makeOutputFolder(folder);
  }
  ~NewFolder() {
    std::error_code ignored;
    if (!was_there_) std::filesystem::remove(folder_, ignored);  // only if empty
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  bool wasThere() const { return was_there_; }

 private:
  std::filesystem::path folder_;
  bool was_there_;
};

// Lock file for one process at a time: on one machine, or on several if the file system supports locks (NFS
// from version 4, Lustre with flock). The lock is released when that process and those that inherited it have
// ended, in any way.
class FileLock {
 public:
  // Acquires the lock if it is free. Throws CalibrationError (CalibrationFailed) if the file cannot be
  // created.
  explicit FileLock(const std::filesystem::path& file);
  ~FileLock();
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&&) = delete;

  bool taken() const { return taken_; }  // by this process
  bool tryAgain();
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_ = -1;
  bool taken_ = false;
};

}  // namespace evical
