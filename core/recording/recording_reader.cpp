#include "core/recording/recording_reader.h"

#include "core/base/error.h"
#include "core/recording/rosbag_reader.h"
#include "core/recording/text_reader.h"

#include <fstream>

namespace evical {
namespace {

constexpr const char* kReadable =
    "Readable are ROS 1 bags (format 2.0) and text: a folder with events.txt and imu.txt, or one such file.";

std::string firstBytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw badInput(path.string(), "the file cannot be opened", "Check its permissions.");
  std::string bytes(1024, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

}  // namespace

std::unique_ptr<RecordingReader> openRecording(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path))
    throw badInput(path.string(), "there is no such file or folder", "Check the path.");
  if (std::filesystem::is_directory(path)) {
    if (std::filesystem::exists(path / "events.txt") || std::filesystem::exists(path / "imu.txt")) {
      return std::make_unique<TextReader>(path);
    }
    throw badInput(path.string(), "the folder has no events.txt or imu.txt", kReadable);
  }
  const std::string start = firstBytes(path);
  if (start.empty()) throw badInput(path.string(), "the file is empty", "Record again, or copy it again.");
  if (start.starts_with(rosbag::kMagic)) return std::make_unique<RosbagReader>(path);
  if (start.starts_with("#ROSBAG")) {
    throw badInput(path.string(), "this is a bag of an old format",
                   "Convert it with `rosbag fix` or `rosbag migrate`.");
  }
  if (start.starts_with("version https://git-lfs")) {
    throw badInput(path.string(), "this is a pointer of Git LFS, not the recording",
                   "Fetch it with `git lfs pull`.");
  }
  if (start.starts_with("PK\3\4") || start.starts_with("7z\xBC\xAF")) {
    throw badInput(path.string(), "this is an archive", "Unpack it first.");
  }
  if (textTableType(start) != StreamType::Other) return std::make_unique<TextReader>(path);
  throw badInput(path.string(), "the format is not known", kReadable);
}

}  // namespace evical
