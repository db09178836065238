// Files of a ROS recording, opened with any compression.
#pragma once

#include "core/recording/ros/message_source.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace evical::ros {

// A file, or a folder's files in the order of its metadata.yaml; if that is missing or damaged, in the order
// of their numbers. Throws CalibrationError (BadInput) if there are none.
std::vector<std::filesystem::path> rosFiles(const std::filesystem::path& path, const FaultSink& sink);

// True if a folder looks like a ROS 2 recording.
bool isRos2Folder(const std::filesystem::path& folder);

// By content: a ROS 1 bag, or MCAP or sqlite3; those packed with zstd (compression_mode FILE) are unpacked to
// a temporary file.
std::unique_ptr<MessageSource> openRosFile(const std::filesystem::path& path, const FaultSink& sink);

// A file packed with zstd, unpacked into the folder of the system's temporary files.

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
