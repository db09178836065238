// Lock file for one process at a time: on one machine, or on several if the file system supports locks (NFS
// from version 4, Lustre with flock). The lock is released when that process and those that inherited it have
// ended, in any way.
#pragma once

#include <filesystem>

namespace evical {

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
