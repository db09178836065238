#include "core/recording/ros/ros_files.h"

#include "core/base/error.h"
#include "core/base/yaml_node.h"
#include "core/recording/ros/bag_source.h"
#include "core/recording/ros/compression.h"
#include "core/recording/ros/mcap_source.h"
#include "core/recording/ros/sqlite_source.h"
#include "core/recording/ros/zstd_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <tuple>
#include <utility>

namespace evical::ros {
namespace {

namespace fs = std::filesystem;

bool isRecordingFile(const fs::path& path) {
  const std::string name = path.filename().string();
  for (const char* ending : {".db3", ".mcap", ".db3.zstd", ".mcap.zstd"})
    if (name.ends_with(ending)) return true;
  return false;
}

// "bag_10" is after "bag_9".
std::vector<fs::path> filesByNumber(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (isRecordingFile(entry.path())) files.push_back(entry.path());
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    const std::string left = a.filename().string(), right = b.filename().string();
    return std::tuple(left.size(), left) < std::tuple(right.size(), right);
  });
  return files;
}

// Only files in the folder: metadata may come from anywhere.
std::vector<fs::path> filesOfMetadata(const fs::path& folder) {
  std::vector<fs::path> files;
  const YamlNode info = YamlNode::load(folder / "metadata.yaml")["rosbag2_bagfile_information"];
  for (const YamlNode& item : info["relative_file_paths"].items())
    files.push_back(folder / fs::path(item.anyText()).filename());
  return files;
}

// Old versions of ROS 2 name a packed file without its ending, or with that of another.
fs::path existing(const fs::path& path) {
  if (fs::exists(path)) return path;
  const fs::path packed = path.string() + ".zstd";
  return fs::exists(packed) ? packed : path;
}

std::string magicBytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw badInput(path.string(), "the file cannot be opened", "Check its permissions");
  std::string bytes(16, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

// Keeps the temporary file during the lifetime of its source.
class UnpackedSource : public MessageSource {
 public:
  UnpackedSource(const fs::path& path, const FaultSink& sink)
      : file_(path, sink), source_(openRosFile(file_.path(), sink)) {}

  const char* format() const override { return source_->format(); }
  const std::vector<SourceTopic>& topics() const override { return source_->topics(); }
  bool isIndexed() const override { return source_->isIndexed(); }
  void want(std::vector<bool> topics) override { source_->want(std::move(topics)); }
  bool next(SourceMessage& message) override { return source_->next(message); }
  void rewind() override { source_->rewind(); }
  std::string place() const override { return source_->place(); }
  double fractionRead() const override { return source_->fractionRead(); }

 private:
  UnpackedZstdFile file_;
  std::unique_ptr<MessageSource> source_;
};

}  // namespace

std::vector<fs::path> rosFiles(const fs::path& path, const FaultSink& sink) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> files;
  if (fs::exists(path / "metadata.yaml")) {
    try {
      files = filesOfMetadata(path);
    } catch (const CalibrationError& error) {
      sink(FaultKind::Metadata,
           fmt::format("The folder's metadata.yaml cannot be used ({}); its files are read in the "
                       "order of their numbers.",
                       error.what()));
    }
  }
  for (fs::path& file : files) file = existing(file);
  std::erase_if(files, [&](const fs::path& file) {
    if (fs::exists(file)) return false;
    sink(FaultKind::Truncated, fmt::format("The file {} is missing.", file.filename().string()));
    return true;
  });
  if (files.empty()) files = filesByNumber(path);
  if (!files.empty()) return files;
  throw badInput(path.string(), "the folder has no .db3 or .mcap file", "Copy the whole folder");
}

bool isRos2Folder(const fs::path& folder) {
  if (fs::exists(folder / "metadata.yaml")) return true;
  return !filesByNumber(folder).empty();
}

std::unique_ptr<MessageSource> openRosFile(const fs::path& path, const FaultSink& sink) {
  const std::string start = magicBytes(path);
  if (start.starts_with(rosbag::kMagic)) return std::make_unique<BagSource>(path, sink);
  if (start.starts_with(mcap::kMagic.substr(0, 5))) return std::make_unique<McapSource>(path, sink);
  if (start.starts_with(kSqliteMagic)) return std::make_unique<SqliteSource>(path, sink);
  if (start.starts_with(kZstdMagic) && path.extension() != kUnpackedEnding)
    return std::make_unique<UnpackedSource>(path, sink);
  throw badInput(path.string(), start.empty() ? "the file is empty" : "this is not a file of a ROS recording",
                 "Record again, or copy it again");
}

}  // namespace evical::ros
