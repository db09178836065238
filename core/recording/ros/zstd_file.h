// A file packed with zstd, unpacked into the folder of the system's temporary files.
#pragma once

#include "core/recording/ros/message_source.h"

#include <filesystem>

namespace evical::ros {

inline constexpr const char* kUnpackedEnding = ".unpacked";

// Removes its file on destruction. A file that is cut off is unpacked up to the cut.
class UnpackedZstdFile {
 public:
  // Throws CalibrationError: BadInput if nothing can be unpacked, CalibrationFailed if there is no space.
  UnpackedZstdFile(const std::filesystem::path& path, const FaultSink& sink);
  ~UnpackedZstdFile();
  UnpackedZstdFile(const UnpackedZstdFile&) = delete;
  UnpackedZstdFile& operator=(const UnpackedZstdFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace evical::ros
