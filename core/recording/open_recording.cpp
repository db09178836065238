#include "core/recording/joined_reader.h"
#include "core/recording/plain_names_reader.h"
#include "core/recording/recording_reader.h"
#include "core/recording/recording_server.h"
#include "core/recording/recording_writer.h"
#include "core/recording/separate_reader.h"
#include "core/recording/unwrapped_reader.h"

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/recording/aedat/aedat2_reader.h"
#include "core/recording/aedat/aedat3_reader.h"
#include "core/recording/aedat/aedat4_reader.h"
#include "core/recording/event_stream/event_stream_reader.h"
#include "core/recording/hdf5/hdf5_reader.h"
#include "core/recording/numpy/numpy_reader.h"
#include "core/recording/pictures/picture_lists.h"
#include "core/recording/pictures/picture_reader.h"
#include "core/recording/prophesee/raw_header.h"
#include "core/recording/prophesee/raw_reader.h"
#include "core/recording/ros/bag_records.h"
#include "core/recording/ros/compression.h"
#include "core/recording/ros/ros_files.h"
#include "core/recording/ros/ros_reader.h"
#include "core/recording/text/text_bytes.h"
#include "core/recording/text/text_table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

namespace evical {
namespace {

std::unique_ptr<RecordingWriter> createPlainBag(const std::filesystem::path& path,
                                                const std::vector<StreamInfo>& streams) {
  return createBag(path, streams, false);
}

std::unique_ptr<RecordingWriter> createPackedMcap(const std::filesystem::path& path,
                                                  const std::vector<StreamInfo>& streams) {
  return createMcap(path, streams, McapCompression::Zstd);
}

std::unique_ptr<RecordingWriter> createLz4Aedat4(const std::filesystem::path& path,
                                                 const std::vector<StreamInfo>& streams) {
  return createAedat4(path, streams, false);
}

// One line per format; everything that writes recordings uses this table.
constexpr RecordingFormat kFormats[] = {
    {"bag", ".bag", "ROS 1 bag", createPlainBag, true, false, true},
    {"mcap", ".mcap", "ROS 2 recording in MCAP, zstd", createPackedMcap, true, false, true},
    {"aedat4", ".aedat4", "iniVation AEDAT4", createLz4Aedat4, false, false, true},
    {"dsec", ".h5", "HDF5 in DSEC's layout, IMU samples in /imu", createDsec},
    {"raw", ".raw", "Prophesee RAW, EVT 3.0, of one camera", createRaw, false, true},
    {"dat", ".dat", "Prophesee DAT of one camera", createDat, false, true},
    {"text", "", "a folder with events.txt and imu.txt", createText},
    {"csv", "", "a folder with events.csv and imu.csv", createCsv},
};

std::string names() {
  std::vector<std::string> list;
  for (const RecordingFormat& format : kFormats) list.emplace_back(format.name);
  return joined(list);
}

}  // namespace

void RecordingWriter::writeFrame(std::size_t /*stream*/, const Frame& /*frame*/) {
  throw badInput("recording", "this format cannot contain frames", "Choose bag or mcap");
}

void RecordingWriter::flush() {
  throw badInput("recording", "this format cannot be written live", "Choose bag, mcap or aedat4");
}

std::span<const RecordingFormat> recordingFormats() {
  return kFormats;
}

const RecordingFormat& recordingFormat(std::string_view name) {
  const auto found = std::find_if(std::begin(kFormats), std::end(kFormats),
                                  [&](const RecordingFormat& format) { return name == format.name; });
  if (found == std::end(kFormats)) {
    throw badInput(std::string(name), "this format cannot be written",
                   fmt::format("Choose one of: {}", names()));
  }
  return *found;
}

const RecordingFormat& recordingFormatOf(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  for (const RecordingFormat& format : kFormats)
    if (!format.isFolder() && extension == format.extension) return format;
  throw badInput(path.string(), "the name does not determine the format",
                 fmt::format("Choose one of: {}", names()));
}

std::unique_ptr<RecordingWriter> createRecording(const std::filesystem::path& path, const std::string& format,
                                                 const std::vector<StreamInfo>& streams) {
  return recordingFormat(format).create(path, streams);
}

namespace {

using namespace std::string_view_literals;

constexpr const char* kReadable =
    "Use a ROS 1 bag (format 2.0), ROS 2 bag (MCAP, sqlite3), AEDAT 2, 3.1 or 4, Prophesee RAW or DAT, "
    "HDF5 (DSEC, TUM-VIE, M3ED, MVSEC, Metavision), Event Stream, NumPy's .npy or .npz, text or CSV: a "
    "folder with events.txt and imu.txt (or .csv), or one such file, or a folder of pictures (EuRoC, "
    "Kalibr, DSEC, TUM-VIE, others)";

// Other formats that users may try, by their first bytes, or bytes from a place on.
struct OtherFormat {
  std::string_view magic;
  const char *problem, *advice;
  std::size_t at = 0;
};
constexpr const char* kFromVideo =
    "Videos have no times of single frames: record pictures, or a bag or MCAP of sensor_msgs/Image. For "
    "intrinsics only, "
    "write the frames as pictures into a folder";
constexpr const char* kFromPicture = "Give the folder with all pictures";
constexpr const char* kFromPage = "Download it again: a server sent an error or a login page";
constexpr OtherFormat kOtherFormats[] = {
    {"ftypqt"sv, "this is a video (MOV)", kFromVideo, 4},
    {"ftyp"sv, "this is a video (MP4)", kFromVideo, 4},
    {"moov"sv, "this is a video (MOV)", kFromVideo, 4},
    {"mdat"sv, "this is a video (MOV)", kFromVideo, 4},
    {"AVI "sv, "this is a video (AVI)", kFromVideo, 8},
    {"\x1A\x45\xDF\xA3"sv, "this is a video (MKV or WebM)", kFromVideo},
    {"WEBP"sv, "this is a WebP picture, which cannot be read",
     "Convert the pictures to PNG, and give their folder", 8},
    {"GIF8"sv, "this is a GIF picture, which cannot be read",
     "Convert the pictures to PNG, and give their folder"},
    {"\x89PNG"sv, "this is one picture (PNG)", kFromPicture},
    {"\xFF\xD8\xFF"sv, "this is one picture (JPEG)", kFromPicture},
    {"II*\0"sv, "this is one picture (TIFF)", kFromPicture},
    {"MM\0*"sv, "this is one picture (TIFF)", kFromPicture},
    {"\0\0\0\0"sv, "this is one picture (BMP)", kFromPicture, 6},
    {"P5\n"sv, "this is one picture (PGM)", kFromPicture},
    {"P6\n"sv, "this is one picture (PPM)", kFromPicture},
    {"BZh"sv, "this is packed with bzip2", "Unpack it first, with `bunzip2`"},
    {"\xFD"
     "7zXZ"sv,
     "this is packed with xz", "Unpack it first, with `unxz`"},
    {"ustar"sv, "this is a tar archive", "Unpack it first, with `tar -xf`", 257},
    {"Rar!\x1A\x07"sv, "this is a RAR archive", "Unpack it first"},
    {"MATLAB 7.3"sv, "this is a file of MATLAB (.mat)",
     "Export its tables as CSV, or write HDF5 in DSEC's layout"},
    {"MATLAB"sv, "this is a file of MATLAB (.mat)", "Export its tables as CSV"},
    {"<!DOCTYPE"sv, "this is a page of a web site (HTML), not the recording", kFromPage},
    {"<!doctype"sv, "this is a page of a web site (HTML), not the recording", kFromPage},
    {"<html"sv, "this is a page of a web site (HTML), not the recording", kFromPage},
    {"<HTML"sv, "this is a page of a web site (HTML), not the recording", kFromPage},
    {"%PDF"sv, "this is a PDF document", "Give the recording"},
    {"/annex/objects/"sv, "this is a pointer of git-annex, not the recording",
     "Fetch it with `git annex get`"},
    {"version https://git-lfs"sv, "this is a pointer of Git LFS, not the recording",
     "Fetch it with `git lfs pull`"},
    {"PK\3\4"sv, "this is a ZIP archive", "Unpack it first"},
    {"7z\xBC\xAF"sv, "this is a 7z archive", "Unpack it first"},
    {"\x28\xB5\x2F\xFD"sv, "this is packed with zstd", "Unpack it first"},
    {"#ROSBAG"sv, "this is a bag of an old format", "Convert it with `rosbag fix`"},
    {"#!AER-DAT"sv, "this is an AEDAT file of an old version",
     "Convert it with jAER or iniVation's DV to 2.0, 3.1 or 4.0"},
};

const OtherFormat* otherFormat(std::string_view start) {
  const std::string_view text =
      start.substr(std::min(start.find_first_not_of(" \t\r\n\xEF\xBB\xBF"), start.size()));
  for (const OtherFormat& format : kOtherFormats) {
    const bool bmp = format.at == 6;  // its reserved bytes
    if (bmp && !start.starts_with("BM")) continue;
    if (start.substr(std::min(format.at, start.size())).starts_with(format.magic)) return &format;
    if (format.magic.front() == '<' && text.starts_with(format.magic)) return &format;
  }
  return nullptr;
}

// Formats that only their name shows, since their header is missing.
void refuseByName(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".raw")
    throw badInput(path.string(), "this RAW file has no header: it does not begin with \"% \"",
                   "Record it again with its header (lines such as \"% evt 3.0\"), or prepend that of a "
                   "recording of the "
                   "same camera");
  if (extension == ".aedat" || extension == ".aedat2")
    throw badInput(path.string(), "this AEDAT file has no header: it does not begin with \"#!AER-DAT\"",
                   "Prepend the lines \"#!AER-DAT2.0\" and \"# AEChip: \" with the name of the chip, as jAER "
                   "writes them");
}

std::string firstBytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw badInput(path.string(), "the file cannot be opened", "Check its permissions");
  std::string bytes(1024, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

// The type of a packed file follows from its name only.
bool isRos2File(const std::filesystem::path& path, std::string_view start) {
  const std::string name = path.filename().string();
  const bool packed_bag = name.ends_with(".db3.zstd") || name.ends_with(".mcap.zstd");
  return start.starts_with("\x89MCAP"sv) || start.starts_with("SQLite format 3\0"sv) ||
         (start.starts_with(ros::kZstdMagic) && packed_bag);
}

// libhdf5 writes beyond its memory on some damaged files.
std::unique_ptr<RecordingReader> openHdf5(const std::filesystem::path& path, const ColumnNames& names = {}) {
  if (!recordingServer().empty())
    return std::make_unique<SeparateReader>(path, recordingServer(), encodeNames(names));
  return std::make_unique<SeparateReader>(path, [&] { return std::make_unique<Hdf5Reader>(path, names); });
}

// Requires files that can be read twice.
void requireFiles(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::error_code ignored;
    const std::filesystem::file_status status = entry.status(ignored);
    if (std::filesystem::is_other(status))
      throw badInput(entry.path().string(), "this file cannot be read twice (a pipe or device)",
                     "Remove it from the folder");
  }
}

// A reader and the pictures next to its files; one of the two may be missing.
std::unique_ptr<RecordingReader> withPictures(std::unique_ptr<RecordingReader> reader,
                                              pictures::PictureFolder found) {
  std::vector<JoinedReader::Part> parts;
  if (reader) parts.push_back({std::move(reader), ""});
  if (!found.lists.empty()) parts.push_back({std::make_unique<PictureReader>(std::move(found.lists)), ""});
  for (const pictures::SensorFile& imu : found.imus)
    parts.push_back({std::make_unique<TextTableReader>(imu.path), imu.name});
  for (const pictures::SensorFile& events : found.events)
    parts.push_back({openHdf5(events.path), events.name});
  if (parts.size() == 1 && parts.front().name.empty()) return std::move(parts.front().reader);
  return std::make_unique<JoinedReader>(std::move(parts));
}

// Pictures of cameras, with times: others next to a table may show anything. The reader of the text has its
// IMU.
pictures::PictureFolder picturesBesideText(const std::filesystem::path& path) {
  pictures::PictureFolder found = pictures::findRpgPictures(path);
  if (found.lists.empty()) found = pictures::findPictures(path);
  std::erase_if(found.lists, [](const pictures::PictureList& list) { return !list.timed; });
  found.imus.clear();
  found.events.clear();
  return found;
}

void requireNoNames(const std::filesystem::path& path, const ColumnNames& names) {
  if (!names.empty())
    throw badInput(path.string(), "this is neither a text table nor HDF5, so its columns cannot be named",
                   "Remove columns from the session");
}

std::unique_ptr<RecordingReader> openFolder(const std::filesystem::path& path, const ColumnNames& names) {
  requireFiles(path);
  if (isTextFolder(path))
    return withPictures(std::make_unique<TextTableReader>(path, names), picturesBesideText(path));
  if (!names.empty() && hasImuTables(path, names)) return std::make_unique<TextTableReader>(path, names);
  requireNoNames(path, names);
  if (isTumVieFolder(path)) return withPictures(openHdf5(path), pictures::findTumViePictures(path));
  if (ros::isRos2Folder(path)) return std::make_unique<RosReader>(path);
  pictures::PictureFolder found = pictures::findPictures(path);
  if (isNumpyFolder(path)) return withPictures(std::make_unique<NumpyReader>(path), std::move(found));
  if (found.lists.empty()) {
    if (hasImuTables(path, names)) return std::make_unique<TextTableReader>(path, names);
    throw badInput(path.string(), "the folder has no recording: no events, no IMU samples, no pictures",
                   kReadable);
  }
  const bool tum_vie = found.lists.front().layout == "TUM-VIE" && hasTumVieImu(path);
  return withPictures(tum_vie ? openHdf5(path) : nullptr, std::move(found));
}

// Binary formats, by their first bytes; nullptr for others.
std::unique_ptr<RecordingReader> openBinary(const std::filesystem::path& path, std::string_view start) {
  if (start.starts_with(rosbag::kMagic)) return std::make_unique<RosReader>(path);
  if (start.starts_with("% ")) return openProphesee(path);
  if (start.starts_with(kEventStreamMagic)) return openEventStream(path);
  if (start.starts_with(aedat::kMagic)) return std::make_unique<Aedat4Reader>(path);
  if (start.starts_with(kAedat2Magic)) return openAedat2(path);
  if (start.starts_with(kAedat3Magic)) return std::make_unique<Aedat3Reader>(path);
  if (isNumpyFile(path, start)) return std::make_unique<NumpyReader>(path);
  if (isRos2File(path, start)) return std::make_unique<RosReader>(path);
  return nullptr;
}

std::unique_ptr<RecordingReader> openPath(const std::filesystem::path& path, const ColumnNames& names) {
  const std::filesystem::file_status status = std::filesystem::status(path);
  if (!std::filesystem::exists(status)) {
    std::error_code ignored;
    if (std::filesystem::read_symlink(path, ignored).string().find("annex/objects") != std::string::npos)
      throw badInput(path.string(), "this is a link of git-annex to a file that is not here",
                     "Fetch it with `git annex get`");
    throw badInput(path.string(), "does not exist", "Check the path");
  }
  if (std::filesystem::is_directory(status)) return openFolder(path, names);
  if (!std::filesystem::is_regular_file(status)) {
    throw badInput(path.string(), "this cannot be read twice (a pipe or device)", "Give a file or a folder");
  }
  const std::string start = firstBytes(path);
  if (start.empty()) throw badInput(path.string(), "the file is empty", "Record again, or copy it again");
  if (start.starts_with("\x89HDF\r\n\x1A\n"sv)) return openHdf5(path, names);
  // The table header "% time, x, y, p" begins like Prophesee's files.
  if (!start.starts_with("% ") || !isTextTable(path))
    if (std::unique_ptr<RecordingReader> reader = openBinary(path, start)) {
      requireNoNames(path, names);
      return reader;
    }
  const bool is_table = isTextTable(path);
  if (isGzip(start) && !is_table)
    throw badInput(path.string(), "this is packed with gzip, but is not a text", "Unpack it first");
  if (const OtherFormat* other = otherFormat(start))
    throw badInput(path.string(), other->problem, other->advice);
  if (!names.empty() || is_table) return std::make_unique<TextTableReader>(path, names);
  if (prophesee::isBareDat(start)) return openProphesee(path);
  refuseByName(path);
  throw badInput(path.string(), "the format is unknown", kReadable);
}

}  // namespace

std::unique_ptr<RecordingReader> openRecording(const std::filesystem::path& path, const ColumnNames& names) {
  try {
    return std::make_unique<UnwrappedReader>(withPlainNames(openPath(path, names)));
  } catch (const std::filesystem::filesystem_error& error) {
    throw badInput(path.string(), "cannot be accessed: " + error.code().message(),
                   "Check the path and its permissions");
  }
}

std::size_t findStream(const RecordingReader& reader, const std::string& name,
                       std::span<const StreamType> types) {
  std::vector<std::string> names;
  std::string kind;
  for (const StreamType type : types) {
    kind += (kind.empty() ? "" : type == types.back() ? " or " : ", ") + std::string(streamTypeName(type));
    for (std::size_t i = 0; i < reader.streams().size(); ++i) {
      const StreamInfo& stream = reader.streams()[i];
      if (stream.type != type) continue;
      if (stream.name == name) return i;
      names.push_back(stream.name);
    }
  }
  const std::string nearest = nearestName(name, names);
  throw badInput(name, fmt::format("the recording has no stream of type {} with this name", kind),
                 names.empty()
                     ? fmt::format("It has no stream of type {} at all", kind)
                     : fmt::format("{}Its streams of this type: {}",
                                   nearest.empty() ? "" : "Did you mean '" + nearest + "'? ", joined(names)));
}

const char* streamTypeName(StreamType type) {
  switch (type) {
    case StreamType::Events:
      return "events";
    case StreamType::Imu:
      return "imu";
    case StreamType::Frames:
      return "frames";
    case StreamType::Points:
      return "points";
    case StreamType::Triggers:
      return "triggers";
    case StreamType::Other:
      break;
  }
  return "other";
}

}  // namespace evical
