#include "core/recording/recording_reader.h"

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/recording/input_file.h"
#include "core/recording/rosbag_format.h"
#include "core/recording/rosbag_reader.h"
#include "core/recording/text_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

namespace evical {
namespace {

constexpr const char* kReadable =
    "Readable are ROS 1 bags (format 2.0), text files (t x y p), and directories with events.txt and imu.txt";

// What people may well hand us, by its first bytes.
struct KnownFormat {
  std::string_view magic;
  const char *problem, *advice;
};
using namespace std::string_view_literals;
constexpr std::array kOtherFormats = {
    KnownFormat{"version https://git-lfs"sv, "is a pointer of git-lfs, not the recording itself",
                "Fetch the recording with `git lfs pull`"},
    KnownFormat{"PK\3\4"sv, "is a ZIP archive", "Unpack it first"},
    KnownFormat{"7z\xBC\xAF\x27\x1C"sv, "is a 7z archive", "Unpack it first"},
    KnownFormat{"\x1F\x8B"sv, "is packed with gzip", "Unpack it first"},
    KnownFormat{"\x28\xB5\x2F\xFD"sv, "is packed with zstd", "Unpack it first"},
    KnownFormat{"#ROSBAG V"sv, "is a ROS bag of an old format", "Convert it with `rosbag fix`"},
    KnownFormat{"SQLite format 3\0"sv, "is a ROS 2 bag (or another SQLite file), which cannot be read yet",
                kReadable},
    KnownFormat{"\x89MCAP"sv, "is an MCAP file, which cannot be read yet", kReadable},
    KnownFormat{"#!AER-DAT"sv, "is an AEDAT file, which cannot be read yet", kReadable},
    KnownFormat{"% "sv, "is a Prophesee RAW or DAT file, which cannot be read yet", kReadable},
    KnownFormat{"\x89HDF\r\n\x1A\n"sv, "is an HDF5 file, which cannot be read yet", kReadable},
    KnownFormat{"Event Stream"sv, "is an Event Stream file, which cannot be read yet", kReadable},
};

// Text has none of the control characters that binary files are full of.
bool looksLikeText(std::string_view start) {
  return std::all_of(start.begin(), start.end(), [](char character) {
    return static_cast<unsigned char>(character) >= 32 || character == '\t' || character == '\n' ||
           character == '\r';
  });
}

std::unique_ptr<RecordingReader> openFile(const std::filesystem::path& path) {
  std::vector<std::uint8_t> bytes;
  {
    const InputFile file(path);
    if (file.size() == 0) throw badInput(path.string(), "is empty", "Record again, or give another file");
    file.readAt(0, 512, bytes);
  }
  const std::string_view start = textOf(bytes);
  if (start.starts_with(kBagMagic)) return std::make_unique<RosbagReader>(path);
  for (const KnownFormat& format : kOtherFormats)
    if (start.starts_with(format.magic)) throw badInput(path.string(), format.problem, format.advice);
  if (looksLikeText(start)) return std::make_unique<TextReader>(path);
  throw badInput(path.string(), "has a format that is not known", kReadable);
}

}  // namespace

std::unique_ptr<RecordingReader> openRecording(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status))
    throw badInput(path.string(), "there is no such file or directory", "Check the path of the recording");
  if (!std::filesystem::is_directory(status)) return openFile(path);
  if (TextReader::directoryHolds(path)) return std::make_unique<TextReader>(path);
  throw badInput(path.string(), "is a directory without events.txt or imu.txt", kReadable);
}

std::size_t findStream(const RecordingReader& reader, const std::string& name, StreamType type) {
  std::vector<std::string> names;
  const std::vector<StreamInfo>& streams = reader.streams();
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (streams[i].type != type) continue;
    if (streams[i].name == name) return i;
    names.push_back(streams[i].name);
  }
  const std::string advice =
      names.empty() ? fmt::format("The recording has no stream of type {} at all", streamTypeName(type))
                    : fmt::format("Its streams of this type: {}", joined(names));
  throw badInput(name,
                 fmt::format("the recording has no stream of type {} with this name", streamTypeName(type)),
                 advice);
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
      return "other";
  }
  return "other";
}

}  // namespace evical
