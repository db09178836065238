#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/recording/recording_writer.h"

#include <fmt/format.h>

#include <algorithm>

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
    {"bag", ".bag", "ROS 1 bag", createPlainBag, true},
    {"mcap", ".mcap", "ROS 2 recording in MCAP, zstd", createPackedMcap, true},
    {"aedat4", ".aedat4", "iniVation AEDAT4", createLz4Aedat4},
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

}  // namespace evical
