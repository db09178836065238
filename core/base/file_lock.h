// A file that one process at a time may hold, on one machine or, where the file system passes locks on (NFS from version 4,
// Lustre with flock), on many. It is free again when that process and those that inherited it have ended, however they did.
#pragma once

#include <filesystem>

namespace evical {

class FileLock {
 public:
  // Takes it if it is free. Throws CalibrationError (CalibrationFailed) if the file cannot be made.
  explicit FileLock(const std::filesystem::path& file);
  ~FileLock();
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&&) = delete;

  bool taken() const { return taken_; }  // by us
  bool tryAgain();
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_ = -1;
  bool taken_ = false;
};

}  // namespace evical
