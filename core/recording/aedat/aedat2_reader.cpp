#include "core/recording/aedat/aedat2_reader.h"

#include "core/base/error.h"
#include "core/numerics/robust.h"
#include "core/recording/aedat/aedat2_decoder.h"
#include "core/recording/aedat/chips.h"
#include "core/recording/block_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

namespace evical {
namespace {

using aedat::AddressLayout;

constexpr std::size_t kLargestAedat2Header_bytes = std::size_t{1} << 24;
constexpr std::size_t kLooked_bytes = std::size_t{1} << 23;  // if the header does not state it
constexpr Resolution kDavisSizes[] = {{240, 180}, {346, 260}, {640, 480}};

struct Header {
  std::string chip;  // "Davis346blue"; empty if unknown
  std::uint64_t size = 0;
};

// The first event's bytes may look like the begin of a header line, but hardly like text up to an end of
// line.
bool isHeaderLine(std::string_view line) {
  const auto isText = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0x20 || byte == '\t' || byte == '\r';
  };
  return line.starts_with('#') && std::all_of(line.begin(), line.end(), isText);
}

// `bytes` are the file's first.
Header readAedat2Header(std::string_view bytes) {
  constexpr std::string_view kChip = "# AEChip: ", kEnd = "#End Of ASCII Header";
  Header header;
  for (;;) {
    const std::size_t end = bytes.find('\n', header.size);
    if (end == std::string_view::npos) return header;
    const std::string_view line = bytes.substr(header.size, end - header.size);
    if (!isHeaderLine(line)) return header;
    header.size = end + 1;
    if (line.starts_with(kEnd)) return header;
    if (!line.starts_with(kChip)) continue;
    header.chip = line.substr(kChip.size());
    while (!header.chip.empty() && header.chip.back() <= ' ') header.chip.pop_back();
    header.chip.erase(0, header.chip.rfind('.') + 1);
  }
}

std::string bytesAt(std::ifstream& file, std::uint64_t offset, std::size_t most) {
  file.clear();
  file.seekg(0, std::ios::end);
  const auto size = static_cast<std::uint64_t>(file.tellg());
  std::string bytes(static_cast<std::size_t>(std::min<std::uint64_t>(most, size - std::min(offset, size))),
                    '\0');
  file.seekg(static_cast<std::streamoff>(offset));
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

struct Look {
  bool wide = false;  // most addresses have more bits than those of a DVS128
  bool imu = false, frames = false;
  Resolution reach_px;                // of a DAVIS's events
  std::vector<double> accelerations;  // norms, at a full scale of 4 g
};

// The full scales at which the median acceleration is closest to gravity. jAER sets 4 g and 500 deg/s, and
// for some DAVIS240C 8 g and 1000 deg/s.
double imuRanges(const Look& look) {
  constexpr double kNear_g = 0.1;
  return !look.accelerations.empty() && std::abs(medianOf(look.accelerations) - 0.5) < kNear_g ? 2.0 : 1.0;
}

Look lookAt(std::string_view bytes) {
  Look look;
  std::size_t wide = 0;
  std::array<double, 3> force_g{};
  for (std::size_t at = 0; at + aedat::kAedat2Record_bytes <= bytes.size();
       at += aedat::kAedat2Record_bytes) {
    const std::uint32_t address = aedat::bigEndian32(bytes.data() + at);
    if (address >> 16 != 0) ++wide;
    if (aedat::isDavisImuWord(address)) {
      look.imu = true;
      const unsigned code = aedat::davisImuCode(address);
      if (code < force_g.size()) force_g[code] = aedat::davisAcceleration_g(address);
      if (code + 1 == force_g.size())
        look.accelerations.push_back(std::hypot(force_g[0], force_g[1], force_g[2]));
    }
    look.frames = look.frames || aedat::isApsSample(address);
    if (!aedat::isDavisEvent(address)) continue;
    look.reach_px.width_px = std::max(look.reach_px.width_px, static_cast<int>(aedat::davisX(address)) + 1);
    look.reach_px.height_px = std::max(look.reach_px.height_px, static_cast<int>(aedat::davisY(address)) + 1);
  }
  look.wide = 2 * wide > bytes.size() / aedat::kAedat2Record_bytes;
  return look;
}

// Smallest sensor that covers all events so far.
Resolution smallestDavis(const Resolution& reach_px) {
  for (const Resolution& size_px : kDavisSizes)
    if (reach_px.width_px <= size_px.width_px && reach_px.height_px <= size_px.height_px) return size_px;
  return kDavisSizes[std::size(kDavisSizes) - 1];
}

StreamInfo aedat2Stream(const char* name, StreamType type, const std::string& chip) {
  StreamInfo stream;
  stream.name = name;
  stream.type = type;
  stream.message = chip;
  stream.time_unit_ns = 1000;
  stream.acceleration_unit = AccelerationUnit::Gravity;
  stream.angular_rate_unit = AngularRateUnit::DegreesPerSecond;
  return stream;
}

// Determines facts that are missing in the header from the events.
void guessChip(const Look& look, std::string& chip, Resolution& size_px, BlockFormat& format) {
  chip = look.wide ? "DAVIS" : "DVS128";
  size_px = look.wide ? smallestDavis(look.reach_px) : aedat::chipSize(chip);
  format.notes.push_back(
      {"events", FaultKind::Guess, 0.0,
       fmt::format("The header does not name the sensor; its events suggest a {} of {} x {} pixels.", chip,
                   size_px.width_px, size_px.height_px)});
}

}  // namespace

std::unique_ptr<RecordingReader> openAedat2(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw badInput(path.string(), "the file cannot be opened", "Check its permissions");
  const Header header = readAedat2Header(bytesAt(file, 0, kLargestAedat2Header_bytes));
  const Look look = lookAt(bytesAt(file, header.size, kLooked_bytes));
  BlockFormat format;
  format.name = "aedat2";
  format.data_offset = header.size;
  std::string chip = header.chip;
  Resolution size_px = aedat::chipSize(chip);
  if (chip.empty()) guessChip(look, chip, size_px, format);
  if (!size_px.known()) {
    throw badInput(path.string(), fmt::format("this is an AEDAT 2.0 file of the sensor \"{}\"", chip),
                   "Convert it with jAER or DV; only DVS128 and DAVIS sensors are supported");
  }
  const AddressLayout layout = chip.starts_with("DVS128") ? AddressLayout::Dvs128 : AddressLayout::Davis;
  const double ranges = imuRanges(look);
  format.streams.push_back(aedat2Stream("events", StreamType::Events, chip));
  format.streams.back().resolution_px = size_px;
  if (layout == AddressLayout::Davis && look.imu) {
    format.streams.push_back(aedat2Stream("imu", StreamType::Imu, "MPU-6150"));
    format.notes.push_back(
        {"imu", FaultKind::Guess, 0.0,
         fmt::format(
             "The file does not state the IMU's full scales. {:g} g and {:g} deg/s are assumed, which jAER "
             "sets{}. Check that the acceleration at rest is 1 g.",
             4.0 * ranges, 500.0 * ranges,
             ranges == 1.0 ? "" : " for some sensors: its usual ones would give half of gravity")});
  }
  if (layout == AddressLayout::Davis && look.frames) {
    format.streams.push_back(aedat2Stream("frames", StreamType::Frames, chip));
    format.streams.back().resolution_px = size_px;
  }
  format.streams.push_back(aedat2Stream("triggers", StreamType::Triggers, chip));
  return std::make_unique<BlockReader>(path, std::move(format),
                                       std::make_unique<aedat::Aedat2Decoder>(layout, size_px, ranges));
}

}  // namespace evical
