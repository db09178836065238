// Readers of recordings, one program per family (EVICAL_FUZZ_FAMILY): the bytes become a file, which is
// opened by its content, read to its end and inspected, and must satisfy the readers' guarantees. Bytes that
// do not begin like a file of the family are skipped.
#include "core/base/error.h"
#include "core/base/time.h"
#include "core/recording/hdf5/hdf5_reader.h"
#include "core/recording/inspection.h"
#include "core/recording/recording_reader.h"
#include "tests/fuzz/input_file.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace std::string_view_literals;

struct Family {
  std::string_view name;
  std::string_view begin;  // magic bytes of its files; empty if they may begin with anything
  const char* file;        // some are identified by their names
};
constexpr Family kFamilies[] = {
    {"bag", "#ROSBAG V2.0\n"sv, "input.bag"},
    {"mcap", "\x89MCAP0\r\n"sv, "input.mcap"},
    {"db3", "SQLite format 3\0"sv, "input.db3"},
    {"packed", "\x28\xB5\x2F\xFD"sv, "input.mcap.zstd"},
    {"aedat2", "#!AER-DAT2.0"sv, "input.aedat"},
    {"aedat3", "#!AER-DAT3.1"sv, "input.aedat"},
    {"aedat4", "#!AER-DAT4.0\r\n"sv, "input.aedat4"},
    {"hdf5", "\x89HDF\r\n\x1A\n"sv, "input.h5"},
    {"npy", "\x93NUMPY"sv, "input.npy"},
    {"npz", "PK\3\4"sv, "input.npz"},
    {"raw", "% "sv, "input.raw"},
    {"es", "Event Stream"sv, "input.es"},
    {"text", ""sv, "input.csv"},
    {"tables", ""sv, "input.csv"},  // the bytes choose a table's names, units and cells
    {"pictures", ""sv, "data.csv"},
};

const Family& family() {
  static const Family& chosen = *std::find_if(std::begin(kFamilies), std::end(kFamilies),
                                              [](const Family& f) { return f.name == EVICAL_FUZZ_FAMILY; });
  return chosen;
}

// Guarantees of readers.
void checkPacket(const evical::RecordingReader& reader, const evical::Packet& packet) {
  const auto before = [](const evical::Event& a, const evical::Event& b) { return a.time_ns < b.time_ns; };
  const bool ordered = std::is_sorted(packet.events.begin(), packet.events.end(), before);
  const bool timed = packet.events.empty() || (evical::isTime(packet.events.front().time_ns) &&
                                               evical::isTime(packet.events.back().time_ns));
  const bool filled = !packet.empty();
  if (!ordered || !timed || !filled || packet.stream >= reader.streams().size()) std::abort();
  for (const evical::RawImuSample& sample : packet.imu_samples)
    if (!evical::isTime(sample.time_ns)) std::abort();
  for (const evical::Frame& frame : packet.frames) {
    const bool encoded = frame.format == evical::FrameFormat::Encoded;
    const std::size_t rows_bytes = frame.row_bytes * static_cast<std::size_t>(frame.size_px.height_px);
    const bool whole =
        encoded ? !frame.bytes.empty() : frame.size_px.known() && rows_bytes <= frame.bytes.size();
    if (!whole || !evical::isTime(frame.time_ns)) std::abort();
  }
}

// A table whose header and cells the bytes choose from those of programs, and some without any meaning.
std::string tableFrom(const std::uint8_t* data, std::size_t size) {
  constexpr const char* kNames[] = {
      "t",       "time",  "timestamp", "stamp_sec", "stamp_nsec", "T",       "ax",
      "ay",      "az",    "gx",        "gy",        "gz",         "x",       "y",
      "z",       "p",     "acc_x",     "gyro_y",    "imu0_az",    "imu1_az", "imu0_gx",
      "imu1_gx", "I",     "imu_id",    "ang_x",     "alpha_x",    "w_x",     "q_w",
      "t_x",     "point", "type",      "sigma",     "",           "\"a b\"", "seconds_elapsed",
      "raw_ax",  "x0",    "\xC2\xB5",  "-",         "%"};
  constexpr const char* kUnits[] = {
      "",     "",         "",         "_s",       "_ns", " [us]",      "(ms)",
      " [g]", " [m/s^2]", "_dps",     " [rad/s]", "[C]", " [0.001 g]", " [1/16.4 deg/s]",
      " []",  "[",        " [1/0 g]", "_"};
  constexpr const char* kCells[] = {"0",
                                    "1",
                                    "9.8",
                                    "-0.5",
                                    "1700000000.5",
                                    "1700000000000000000",
                                    "1.70000E+18",
                                    "12:34:56.789",
                                    "23:59:59",
                                    "2026-03-01T10:00:00Z",
                                    "",
                                    "NaN",
                                    "x",
                                    "1.700.000",
                                    "0x1F",
                                    "true",
                                    "1,5",
                                    "-9223372036854775808",
                                    "1e308",
                                    "100.5000000",
                                    "0.",
                                    "."};
  constexpr const char* kAbove[] = {"",
                                    "GYROFLOW IMU LOG\n",
                                    "tscale,1e-6\n",
                                    "gscale,0.001\nascale,1e300\n",
                                    "orientation,YxZ\n",
                                    "# a comment\n",
                                    "sep=;\n",
                                    "%geometry:640,480\n",
                                    "346 260\n"};
  constexpr char kSeparators[] = {',', ';', '\t', ' '};
  std::size_t at = 0;
  const auto next = [&]() -> std::size_t { return at < size ? data[at++] : 0; };
  const auto one = [&](const auto& of) { return std::string(of[next() % std::size(of)]); };
  const char separator = kSeparators[next() % std::size(kSeparators)];
  const std::size_t columns = 1 + next() % 16, distinct = 1 + next() % 6, rows = next() % 48;
  std::string text = one(kAbove);
  for (std::size_t i = 0; i < columns; ++i)
    text += one(kNames) + one(kUnits) + (i + 1 < columns ? separator : '\n');
  std::string lines;
  for (std::size_t k = 0; k < distinct; ++k) {
    const std::size_t width = next() % 8 == 1 ? next() % 20 : columns;  // some rows are ragged
    for (std::size_t i = 0; i < width; ++i)
      lines += one(kCells) + (i + 1 < width ? std::string(1, separator) : "");
    lines += "\n";
  }
  for (std::size_t k = 0; k < rows; ++k) text += lines;
  return text;
}

// The bytes are the list of images and also the content of one of them.
std::unique_ptr<evical::RecordingReader> openPictures(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.parent_path();
  std::filesystem::create_directory(folder / "data");
  const auto anew = std::filesystem::copy_options::overwrite_existing;
  std::filesystem::copy_file(path, folder / "data" / "1.png", anew);
  return evical::openRecording(folder);
}

// HDF5 in this process: crashes in it are the purpose of the test.
std::unique_ptr<evical::RecordingReader> opened(const std::filesystem::path& path) {
  if (family().name == "hdf5") return std::make_unique<evical::Hdf5Reader>(path);
  if (family().name == "pictures") return openPictures(path);
  return evical::openRecording(path);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const evical::fuzz::InputFile input(family().file);
  if (!std::string_view(reinterpret_cast<const char*>(data), size).starts_with(family().begin)) return -1;
  std::string table;
  if (family().name == "tables") {
    table = tableFrom(data, size);
    data = reinterpret_cast<const std::uint8_t*>(table.data());
    size = table.size();
  }
  try {
    const auto reader = opened(input.write(data, size));
    // Counting pixels takes ten times as long as reading a small file: only some inputs do it, selected by
    // their size.
    if (size % 8 == 0) {
      evical::inspectionJson(evical::inspectRecording(*reader), true);
      return 0;
    }
    std::vector<std::size_t> streams;  // also frames, which are not read by default
    for (std::size_t i = 0; i < reader->streams().size(); ++i)
      if (reader->streams()[i].readable) streams.push_back(i);
    if (!streams.empty()) reader->select(streams);
    evical::Packet packet;
    while (reader->read(packet)) checkPacket(*reader, packet);
  } catch (const evical::CalibrationError&) {
    // Bad files cause this error.
  }
  return 0;
}
