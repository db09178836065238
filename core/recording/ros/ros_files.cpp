#include "core/recording/ros/ros_files.h"

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/yaml_node.h"
#include "core/recording/ros/bag_source.h"
#include "core/recording/ros/compression.h"
#include "core/recording/ros/mcap_source.h"
#include "core/recording/ros/sqlite_source.h"
#include "core/recording/unpacking_limit.h"

#include <fmt/format.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <new>
#include <regex>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

namespace evical::ros {
namespace {

namespace fs = std::filesystem;

bool isRecordingFile(const fs::path& path) {
  const std::string name = path.filename().string();
  for (const char* ending : {".db3", ".mcap", ".db3.zstd", ".mcap.zstd"})
    if (name.ends_with(ending)) return true;
  return false;
}

// Name of a part of a split recording: "a_3.bag", "a_3.mcap". It may also contain its start time, which
// differs: "a_2024-05-06-07-08-09_2.bag".
const std::regex& numberedPart() {
  static const std::regex numbered(R"((.*?)(_\d{4}(?:-\d{2}){5})?_(\d{1,6})\.(bag|db3|mcap)(?:\.zstd)?)");
  return numbered;
}

// Parts before and after this one. They count from 0: without part 0 these are recordings that a person
// numbered.
std::vector<std::string> otherParts(const fs::path& path) {
  const std::regex& numbered = numberedPart();
  std::smatch own, other;
  const std::string name = path.filename().string();
  std::vector<std::string> parts;
  if (!std::regex_match(name, own, numbered)) return parts;
  const int number = std::stoi(own[3]);
  bool has_first = number == 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path.parent_path() / ".", error)) {
    const std::string candidate = entry.path().filename().string();
    if (!std::regex_match(candidate, other, numbered)) continue;
    const bool same = own[1] == other[1] && own[2].matched == other[2].matched && own[4] == other[4];
    if (!same) continue;
    const int its_number = std::stoi(other[3]);
    has_first = has_first || its_number == 0;
    if (std::abs(its_number - number) == 1) parts.push_back(candidate);
  }
  if (!has_first) return {};
  std::sort(parts.begin(), parts.end());
  return parts;
}

// The parts of one split ROS 1 recording, if the folder has no other bags.
bool isSplitBag(const std::vector<fs::path>& bags) {
  std::smatch first, other;
  if (bags.size() < 2) return false;
  const std::string first_name = bags.front().filename().string();
  if (!std::regex_match(first_name, first, numberedPart()) || std::stoi(first[3]) != 0) return false;
  for (std::size_t i = 0; i < bags.size(); ++i) {
    const std::string name = bags[i].filename().string();
    const bool next = std::regex_match(name, other, numberedPart()) && other[1] == first[1] &&
                      std::stoi(other[3]) == static_cast<int>(i);
    if (!next) return false;
  }
  return true;
}

// "bag_10" is after "bag_9".
void sortByNumber(std::vector<fs::path>& files) {
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    const std::string left = a.filename().string(), right = b.filename().string();
    return std::tuple(left.size(), left) < std::tuple(right.size(), right);
  });
}

// Files of ROS 2, or the parts of a split recording of ROS 1.
std::vector<fs::path> filesByNumber(const fs::path& folder) {
  std::vector<fs::path> files, bags;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (isRecordingFile(entry.path())) files.push_back(entry.path());
    if (entry.path().extension() == ".bag") bags.push_back(entry.path());
  }
  sortByNumber(bags);
  if (files.empty() && isSplitBag(bags)) files = bags;
  sortByNumber(files);
  return files;
}

// Parts that follow the listed ones: a recorder that crashes lists its last file too late.
std::vector<fs::path> laterParts(const fs::path& folder, const std::vector<fs::path>& listed) {
  std::vector<fs::path> later;
  std::smatch last, other;
  if (listed.empty()) return later;
  const std::string last_name = listed.back().filename().string();
  if (!std::regex_match(last_name, last, numberedPart())) return later;
  for (const fs::path& file : filesByNumber(folder)) {
    const std::string name = file.filename().string();
    const bool follows = std::regex_match(name, other, numberedPart()) && other[1] == last[1] &&
                         other[4] == last[4] && std::stoi(other[3]) > std::stoi(last[3]);
    if (follows && std::ranges::find(listed, file) == listed.end()) later.push_back(file);
  }
  return later;
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
  if (!fs::is_directory(path)) {
    const std::vector<std::string> parts = otherParts(path);
    if (!parts.empty())
      sink(FaultKind::Part,
           fmt::format("The name is that of a part of a split recording: {} {} in the same folder. Only this "
                       "part is read; give the folder to read all.",
                       joined(parts), parts.size() == 1 ? "is" : "are"));
    return {path};
  }
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
  for (const fs::path& file : laterParts(path, files)) {
    sink(FaultKind::Metadata,
         fmt::format("metadata.yaml does not list {}, which is in the folder; it is read, too.",
                     file.filename().string()));
    files.push_back(file);
  }
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

namespace {

struct ClosingFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, ClosingFile>;

File temporaryFile(std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error)
    throw badInput(
        folder.empty() ? "TMPDIR" : folder.string(),
        fmt::format("the temporary folder, into which a packed recording is unpacked, cannot be used: {}",
                    error.message()),
        "Set TMPDIR to an existing folder");
  std::string name = (folder / "evical_XXXXXX").string() + kUnpackedEnding;
  const int descriptor = mkstemps(name.data(), static_cast<int>(std::string_view(kUnpackedEnding).size()));
  path = name;
  return File(descriptor >= 0 ? fdopen(descriptor, "wb") : nullptr);
}

[[noreturn]] void failWriting(const std::filesystem::path& path) {
  throw calibrationFailed(path.string(), "the recording cannot be unpacked into the temporary folder",
                          "Free disk space, or set TMPDIR to another folder");
}

// Returns the number of intact bytes of the input.
std::uint64_t unpack(std::istream& input, const File& output, const std::filesystem::path& target,
                     UnpackingLimit limit, bool& whole) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(), &ZSTD_freeDCtx);
  if (!context) throw std::bad_alloc();
  std::vector<char> packed(ZSTD_DStreamInSize()), plain(ZSTD_DStreamOutSize());
  std::uint64_t good = 0;
  whole = true;
  for (;;) {
    input.read(packed.data(), static_cast<std::streamsize>(packed.size()));
    ZSTD_inBuffer in{packed.data(), static_cast<std::size_t>(input.gcount()), 0};
    if (in.size == 0) return good;
    for (bool full = false; in.pos < in.size || full;) {
      ZSTD_outBuffer out{plain.data(), plain.size(), 0};
      const std::size_t hint = ZSTD_decompressStream(context.get(), &out, &in);
      whole = hint == 0;
      if (ZSTD_isError(hint) != 0U) return good + in.pos;
      limit.add(out.pos);
      if (std::fwrite(plain.data(), 1, out.pos, output.get()) != out.pos) failWriting(target);
      full = out.pos == out.size && !whole;
    }
    good += in.size;
  }
}

}  // namespace

UnpackedZstdFile::UnpackedZstdFile(const std::filesystem::path& path, const FaultSink& sink) {
  std::ifstream input(path, std::ios::binary);
  if (!input) throw badInput(path.string(), "the file cannot be opened", "Check its permissions");
  const File output = temporaryFile(path_);
  if (!output) failWriting(path_);
  try {
    bool whole = false;
    const std::uint64_t good =
        unpack(input, output, path_, {path.string(), std::filesystem::file_size(path)}, whole);
    if (!whole) {
      sink(FaultKind::Truncated,
           fmt::format("The packed file {} is cut off or damaged at byte {}; the part before is read.",
                       path.filename().string(), good));
    }
    if (std::fflush(output.get()) != 0) failWriting(path_);
  } catch (...) {
    std::remove(path_.c_str());
    throw;
  }
}

UnpackedZstdFile::~UnpackedZstdFile() {
  std::error_code error;
  std::filesystem::remove(path_, error);
}

}  // namespace evical::ros
