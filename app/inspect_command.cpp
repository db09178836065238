#include "app/inspect_command.h"
#include "app/command_line.h"
#include "app/output.h"

#include "core/base/number.h"
#include "core/base/time.h"
#include "core/recording/inspection.h"
#include "core/recording/live/live_source.h"
#include "core/recording/recording_reader.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

namespace evical {
namespace {

struct InspectArguments {
  std::string recording;
  bool json = false, checksum = false;
};

// With fixed decimals; without a hundred digits if it is huge.
std::string shown(double value, int decimals) {
  constexpr double kHuge = 1e9;
  return std::abs(value) < kHuge ? fmt::format("{:.{}f}", value, decimals) : fmt::format("{:g}", value);
}

void printVector(const char* title, const Eigen::Vector3d& vector, const std::string& unit) {
  print("    {:<22} {}  {}  {} {}\n", title, shown(vector.x(), 5), shown(vector.y(), 5), shown(vector.z(), 5),
        unit);
}

void printEvents(const StreamSummary& stream, bool checksum) {
  const Resolution& size_px = stream.info.resolution_px;
  print("    {:<22} {} ({} on, {} off), {:.4g} per s\n", "events", stream.count, stream.on, stream.off,
        stream.rate_hz);
  if (size_px.known()) {
    print("    {:<22} {} x {}\n", "resolution", size_px.width_px, size_px.height_px);
  } else {
    print("    {:<22} not in the file; events reach {} x {}\n", "resolution", stream.seen_px.width_px,
          stream.seen_px.height_px);
  }
  if (stream.shortest_interval_s > 0.0)
    print("    {:<22} at most {:.3g} ms (99 % of a pixel's intervals are longer)\n", "refractory period",
          1e3 * stream.shortest_interval_s);
  if (!stream.note.empty()) print("    {:<22} {}\n", "note", stream.note);
  if (!checksum) return;
  print("    {:<22} x {}, y {}, t {} {} (mod 2^64)\n", "sums", stream.sum_x, stream.sum_y, stream.sum_t,
        stream.info.time_unit_ns == 1000 ? "us" : "ns");
}

void printImu(const StreamSummary& stream) {
  print("    {:<22} {}, {:.5g} per s\n", "samples", stream.count, stream.rate_hz);
  const ImuStreamKind kind = imuStreamKind(stream);
  if (kind == ImuStreamKind::Gyroscope) print("    {:<22} gyroscope only\n", "");
  if (kind == ImuStreamKind::Accelerometer) print("    {:<22} accelerometer only\n", "");
  if (kind == ImuStreamKind::Alternating)
    print("    {:<22} {} of the gyroscope and {} of the accelerometer, alternating\n", "",
          stream.without_force, stream.without_rate);
  if (kind == ImuStreamKind::Whole || kind == ImuStreamKind::Accelerometer) {
    printVector("mean specific force", stream.mean_acceleration, stream.acceleration_unit);
    print("    {:<22} {} {}\n", "median of its norm", shown(stream.median_acceleration, 4),
          stream.acceleration_unit);
  }
  if (kind == ImuStreamKind::Whole || kind == ImuStreamKind::Gyroscope)
    printVector("mean angular rate", stream.mean_angular_rate, stream.angular_rate_unit);
}

void printFrames(const StreamSummary& stream) {
  const StreamInfo& info = stream.info;
  print("    {:<22} {}", "frames", stream.count);
  if (stream.rate_hz > 0.0) print(", {:.4g} per s", stream.rate_hz);
  print("\n");
  if (info.resolution_px.known())
    print("    {:<22} {} x {}\n", "resolution", info.resolution_px.width_px, info.resolution_px.height_px);
  if (stream.longest_exposure_s > 0.0)
    print("    {:<22} {:.3f} .. {:.3f} ms\n", "exposure", 1e3 * stream.shortest_exposure_s,
          1e3 * stream.longest_exposure_s);
  const char* use = !info.readable ? "nothing (only listed)"
                    : info.timed   ? "calibration of a frame camera"
                                   : "intrinsics only (no times)";
  print("    {:<22} {}\n", "good for", use);
}

void printStream(const StreamSummary& stream, bool checksum) {
  const StreamInfo& info = stream.info;
  print("\n  {}  [{}, {}]\n", info.name, streamTypeName(info.type), info.message);
  const bool frames = info.type == StreamType::Frames;
  if (frames) printFrames(stream);
  if (info.type != StreamType::Events && info.type != StreamType::Imu && !frames) {
    // Trigger streams are listed if the format can contain them.
    if (stream.count > 0 || info.type == StreamType::Triggers)
      print("    {:<22} {}\n", "messages", stream.count);
    return;
  }
  if (frames && (!info.readable || !info.timed)) return;
  if (info.type == StreamType::Events) printEvents(stream, checksum);
  if (info.type == StreamType::Imu) printImu(stream);
  if (stream.count == 0) return;
  print("    {:<22} {} .. {} ns ({:.3f} s)\n", "time", stream.first_ns, stream.last_ns,
        secondsSince(stream.first_ns, stream.last_ns));
  print("    {:<22} {:.3f} ms; time runs backwards {}\n", "largest gap",
        1e-6 * static_cast<double>(stream.largest_gap_ns), counted(stream.backward_steps, "time"));
}

void printForPeople(const std::string& recording, const Inspection& inspection, bool checksum) {
  print("{} ({}, {})\n", recording, inspection.format, counted(inspection.streams.size(), "stream"));
  for (const StreamSummary& stream : inspection.streams) printStream(stream, checksum);
  print("\n{}\n", inspection.faults.empty() ? "No faults found." : "Faults:");
  for (const RecordingFault& fault : inspection.faults) {
    const std::string place =
        fault.stream.empty() ? "" : fmt::format(" {} at {:.3f} s:", fault.stream, fault.at_s);
    print("  {}:{} {}\n", nameOf(fault.kind), place, fault.text);
  }
}

// A recording, or the first seconds of a server's streams.
Inspection inspected(const std::string& source) {
  constexpr std::chrono::seconds kLook{5};
  if (!isLiveAddress(source)) return inspectRecording(*openRecording(source));
  std::stop_source end;
  const std::unique_ptr<RecordingReader> reader =
      openLive(source, std::filesystem::temp_directory_path(), end.get_token());
  const bool ends_itself = source.find("://") == std::string::npos;
  const std::jthread timer([&](const std::stop_token& done) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any waiting;
    if (!ends_itself) waiting.wait_for(lock, done, kLook, [] { return false; });
    if (!ends_itself) end.request_stop();
  });
  return inspectRecording(*reader);
}

void inspect(const InspectArguments& arguments) {
  const Inspection inspection = inspected(arguments.recording);
  if (arguments.json) {
    print("{}", inspectionJson(inspection, arguments.checksum));
  } else {
    printForPeople(arguments.recording, inspection, arguments.checksum);
  }
}

}  // namespace

void addInspectCommand(Command& app, int& exit_code) {
  const auto arguments = std::make_shared<InspectArguments>();
  Command command = app.command("inspect", "List the streams and faults of a recording");
  command
      .option("RECORDING", arguments->recording,
              "File or folder in any supported format: bag, AEDAT, RAW, HDF5, NumPy, text, pictures; or a "
              "live source as of "
              "`evical record`, of which 5 s are read")
      .required();
  command.flag("--json", arguments->json, "Print JSON instead of text");
  command.flag("--checksum", arguments->checksum, "Add sums over all events, for comparisons of readers");
  command.example("evical inspect recording.bag");
  command.action([arguments, &exit_code] {
    inspect(*arguments);
    exit_code = 0;
  });
}

}  // namespace evical
