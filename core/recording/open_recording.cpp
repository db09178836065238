#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/recording/aedat/aedat4_reader.h"
#include "core/recording/event_stream/event_stream_reader.h"
#include "core/recording/hdf5/hdf5_reader.h"
#include "core/recording/prophesee/raw_header.h"
#include "core/recording/prophesee/raw_reader.h"
#include "core/recording/recording_reader.h"
#include "core/recording/ros/bag_records.h"
#include "core/recording/ros/compression.h"
#include "core/recording/ros/ros_files.h"
#include "core/recording/ros/ros_reader.h"
#include "core/recording/separate_reader.h"
#include "core/recording/text/text_table_reader.h"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

namespace evical {
namespace {

using namespace std::string_view_literals;

constexpr const char* kReadable =
    "Readable are ROS 1 bags (format 2.0), ROS 2 bags (MCAP, sqlite3), AEDAT4, Prophesee RAW and DAT, HDF5 "
    "(DSEC, TUM-VIE, M3ED, MVSEC, Metavision), Event Stream, and text or CSV: a folder with events.txt and "
    "imu.txt (or .csv), or one such file";

// What people may well hand us, by its first bytes.
struct OtherFormat {
  std::string_view magic;
  const char *problem, *advice;
};
constexpr OtherFormat kOtherFormats[] = {
    {"version https://git-lfs"sv, "this is a pointer of Git LFS, not the recording",
     "Fetch it with `git lfs pull`"},
    {"PK\3\4"sv, "this is a ZIP archive", "Unpack it first"},
    {"7z\xBC\xAF"sv, "this is a 7z archive", "Unpack it first"},
    {"\x1F\x8B"sv, "this is packed with gzip", "Unpack it first"},
    {"\x28\xB5\x2F\xFD"sv, "this is packed with zstd", "Unpack it first"},
    {"#ROSBAG"sv, "this is a bag of an old format", "Convert it with `rosbag fix`"},
    {"#!AER-DAT"sv, "this is an AEDAT file of an old version",
     "Convert it to AEDAT4 with iniVation's DV or dv-processing"},
};

std::string firstBytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw badInput(path.string(), "the file cannot be opened", "Check its permissions");
  std::string bytes(1024, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

// Only its name tells what a packed file is.
bool isRos2File(const std::filesystem::path& path, std::string_view start) {
  const std::string name = path.filename().string();
  const bool packed_bag = name.ends_with(".db3.zstd") || name.ends_with(".mcap.zstd");
  return start.starts_with("\x89MCAP"sv) || start.starts_with("SQLite format 3\0"sv) ||
         (start.starts_with(ros::kZstdMagic) && packed_bag);
}

// libhdf5 writes past its own memory on some damaged files.
std::unique_ptr<RecordingReader> openHdf5(const std::filesystem::path& path) {
  return std::make_unique<SeparateReader>(path, [&] { return std::make_unique<Hdf5Reader>(path); });
}

// Of what can be read twice.
void requireFiles(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::error_code ignored;
    const std::filesystem::file_status status = entry.status(ignored);
    if (std::filesystem::is_other(status))
      throw badInput(entry.path().string(), "this is no file that can be read twice",
                     "Take it out of the folder");
  }
}

std::unique_ptr<RecordingReader> openFolder(const std::filesystem::path& path) {
  requireFiles(path);
  if (isTextFolder(path)) return std::make_unique<TextTableReader>(path);
  if (std::filesystem::exists(path / "events.txt") || std::filesystem::exists(path / "imu.txt")) {
    return std::make_unique<TextTableReader>(path);
  }
  if (isTumVieFolder(path)) return openHdf5(path);
  if (ros::isRos2Folder(path)) return std::make_unique<RosReader>(path);
  throw badInput(path.string(), "the folder has no events.txt, imu.txt, events.csv or imu.csv", kReadable);
}

std::unique_ptr<RecordingReader> openPath(const std::filesystem::path& path) {
  const std::filesystem::file_status status = std::filesystem::status(path);
  if (!std::filesystem::exists(status)) {
    throw badInput(path.string(), "there is no such file or folder", "Check the path");
  }
  if (std::filesystem::is_directory(status)) return openFolder(path);
  if (!std::filesystem::is_regular_file(status)) {
    throw badInput(path.string(), "this is no file that can be read twice", "Give a file or a folder");
  }
  const std::string start = firstBytes(path);
  if (start.empty()) throw badInput(path.string(), "the file is empty", "Record again, or copy it again");
  if (start.starts_with(rosbag::kMagic)) return std::make_unique<RosReader>(path);
  if (start.starts_with("% ")) return openProphesee(path);
  if (start.starts_with(kEventStreamMagic)) return openEventStream(path);
  if (start.starts_with("\x89HDF\r\n\x1A\n"sv)) return openHdf5(path);
  if (start.starts_with(aedat::kMagic)) return std::make_unique<Aedat4Reader>(path);
  if (isRos2File(path, start)) return std::make_unique<RosReader>(path);
  for (const OtherFormat& format : kOtherFormats) {
    if (start.starts_with(format.magic)) throw badInput(path.string(), format.problem, format.advice);
  }
  if (textTableType(start) != StreamType::Other) return std::make_unique<TextTableReader>(path);
  if (prophesee::isBareDat(start)) return openProphesee(path);
  throw badInput(path.string(), "the format is not known", kReadable);
}

}  // namespace

std::unique_ptr<RecordingReader> openRecording(const std::filesystem::path& path) {
  try {
    return openPath(path);
  } catch (const std::filesystem::filesystem_error& error) {
    throw badInput(path.string(), "cannot be reached: " + error.code().message(),
                   "Check the path and its permissions");
  }
}

std::size_t findStream(const RecordingReader& reader, const std::string& name, StreamType type) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < reader.streams().size(); ++i) {
    const StreamInfo& stream = reader.streams()[i];
    if (stream.type != type) continue;
    if (stream.name == name) return i;
    names.push_back(stream.name);
  }
  const std::string kind = streamTypeName(type);
  throw badInput(name, fmt::format("the recording has no stream of type {} with this name", kind),
                 names.empty() ? fmt::format("It has no stream of type {} at all", kind)
                               : fmt::format("Its streams of this type: {}", joined(names)));
}

const char* streamTypeName(StreamType type) {
  switch (type) {
    case StreamType::Events:
      return "events";
    case StreamType::Imu:
      return "imu";
    case StreamType::Frames:
      return "frames";
    case StreamType::Triggers:
      return "triggers";
    case StreamType::Other:
      break;
  }
  return "other";
}

}  // namespace evical
