// Decoding speed per format on a simulated recording, as a table: `evical_benchmarks formats [--duration S]
// [--least M] SCENARIO`. CPU time of the process, with files in the page cache. Fails if a packed format is
// slower than `--least` million events/s, or if an event is lost.
#include "core/recording/recording_reader.h"
#include "core/recording/recording_writer.h"
#include "core/synthetic/event_simulator.h"
#include "tests/benchmarks/benchmark_program.h"
#include "tests/core/recording/numpy/numpy_builder.h"
#include "tests/core/recording/ros/ros2_builder.h"
#include "tests/support/packed_events.h"

#include <fmt/format.h>

#include <unistd.h>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace evical::benchmarks::formats {
namespace {

constexpr std::size_t kBatch = 50'000;

// Times from 1 s on, in whole us, as cameras' formats store them.
std::vector<Event> simulatedEvents(const Scenario& scenario) {
  std::vector<Event> events;
  simulateEvents(scenario, 0,
                 [&](EventSpan packet) {
                   for (Event event : packet) {
                     event.time_ns = (event.time_ns - scenario.start_ns) / 1000 * 1000 + 1'000'000'000;
                     events.push_back(event);
                   }
                 },
                 {});
  return events;
}

using Create = std::function<std::unique_ptr<RecordingWriter>(const std::filesystem::path&,
                                                              const std::vector<StreamInfo>&)>;

struct Row {
  std::string name;
  bool packed;
  std::function<void(const std::filesystem::path&)> write;
};

// Lists the formats; the events must outlive the list.
class Rows {
 public:
  Rows(const std::vector<Event>& events, const Resolution& size_px) : events_(events), size_px_(size_px) {
    addWritten();
    addSqlite();
    addCameraFormats();
    addArrays();
  }
  const std::vector<Row>& list() const { return list_; }

 private:
  void addWriter(const std::string& name, bool packed, bool is_folder, const Create& create) {
    list_.push_back({name, packed, [this, is_folder, create](const std::filesystem::path& path) {
                       if (is_folder) std::filesystem::create_directory(path);
                       const auto writer = create(path, {{"events", StreamType::Events, "", size_px_}});
                       for (std::size_t k = 0; k < events_.size(); k += kBatch) writer->write(0, batch(k));
                       writer->finish();
                     }});
  }

  // Formats that Evical writes, and the compressions that `evical convert` has no name for.
  void addWritten() {
    for (const RecordingFormat& format : recordingFormats()) {
      const std::string name = format.name;
      addWriter(format.description, name != "text" && name != "csv", format.isFolder(), format.create);
    }
    addWriter("ROS 1 bag, lz4", true, false,
              [](const auto& path, const auto& streams) { return createBag(path, streams, true); });
    addWriter("MCAP, plain", true, false, [](const auto& path, const auto& streams) {
      return createMcap(path, streams, McapCompression::None);
    });
    addWriter("MCAP, lz4", true, false, [](const auto& path, const auto& streams) {
      return createMcap(path, streams, McapCompression::Lz4);
    });
    addWriter("AEDAT4, zstd", true, false,
              [](const auto& path, const auto& streams) { return createAedat4(path, streams, true); });
  }

  void addSqlite() {
    list_.push_back({"ROS 2 recording in sqlite3", true, [this](const std::filesystem::path& path) {
                       std::vector<test::RosMessage> messages;
                       for (std::size_t k = 0; k < events_.size(); k += kBatch) {
                         const EventSpan span = batch(k);
                         messages.push_back({0, span.front().time_ns,
                                             test::cdrEvents(size_px_, {span.begin(), span.end()})});
                       }
                       test::writeSqliteBag(path, {{"/events", "dvs_msgs/msg/EventArray"}}, messages);
                     }});
  }

  void addCameraFormats() {
    const std::string geometry =
        fmt::format("% geometry {}x{}\n% end\n", size_px_.width_px, size_px_.height_px);
    addEncoded("Prophesee RAW EVT2", "% evt 2.0\n" + geometry, test::encodeEvt2);
    addEncoded("Prophesee RAW EVT2.1", "% evt 2.1\n% endianness little\n" + geometry,
               [](EventSpan events) { return test::encodeEvt21(events, false); });
    addEncoded("Prophesee RAW EVT3", "% evt 3.0\n" + geometry, test::encodeEvt3);
    addEncoded("Prophesee DAT",
               fmt::format("% Version 2\n% Width {}\n% Height {}\n", size_px_.width_px, size_px_.height_px),
               test::encodeDat);
    addEncoded(
        "Event Stream", test::eventStreamHeader(size_px_.width_px, size_px_.height_px, false),
        [this](EventSpan events) { return test::encodeEventStream(events, size_px_.height_px, false); });
  }

  // The formats of numpy.save, numpy.savez and numpy.savez_compressed; without zip64 each array has 4 GB at
  // most.
  void addArrays() {
    addEncoded("NumPy, structured", "", [this](EventSpan events) {
      std::string bytes;
      for (const Event& event : events)
        bytes +=
            timeBytes(event) + test::rawNumber(event.x_px) + test::rawNumber(event.y_px) + polarity(event);
      return test::npyArray("[('t', '<i8'), ('x', '<u2'), ('y', '<u2'), ('p', '|b1')]", shape(), bytes);
    });
    addEncoded("NumPy archive", "", [this](EventSpan events) { return archiveOf(events, false); });
    addEncoded("NumPy archive, deflated", "", [this](EventSpan events) { return archiveOf(events, true); });
    list_.back().packed = false;  // limited by zlib
  }

  static std::string timeBytes(const Event& event) { return test::rawNumber(event.time_ns / 1000); }
  static char polarity(const Event& event) { return event.brighter ? '\1' : '\0'; }
  std::string shape() const { return fmt::format("({},)", events_.size()); }

  std::string archiveOf(EventSpan events, bool deflate) const {
    std::string x, y, t, p;
    for (const Event& event : events) {
      x += test::rawNumber(event.x_px);
      y += test::rawNumber(event.y_px);
      t += timeBytes(event);
      p += polarity(event);
    }
    return test::zipArchive({{"x.npy", test::npyArray("'<u2'", shape(), x), deflate},
                             {"y.npy", test::npyArray("'<u2'", shape(), y), deflate},
                             {"t.npy", test::npyArray("'<i8'", shape(), t), deflate},
                             {"p.npy", test::npyArray("'|b1'", shape(), p), deflate}});
  }

  void addEncoded(const char* name, const std::string& header,
                  const std::function<std::string(EventSpan)>& encode) {
    list_.push_back({name, true, [this, header, encode](const std::filesystem::path& path) {
                       std::ofstream(path, std::ios::binary) << header << encode(events_);
                     }});
  }

  EventSpan batch(std::size_t begin) const {
    return EventSpan(events_).subspan(begin, std::min(kBatch, events_.size() - begin));
  }

  const std::vector<Event>& events_;
  Resolution size_px_;
  std::vector<Row> list_;
};

std::uintmax_t sizeOf(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return std::filesystem::file_size(path);
  std::uintmax_t size = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path)) size += entry.file_size();
  return size;
}

// True if it is fast enough and complete.
bool measure(const Row& row, const std::filesystem::path& path, std::size_t written, double least) {
  row.write(path);
  const double begin = test::processCpu_s();
  const auto reader = openRecording(path);
  Packet packet;
  std::size_t read = 0;
  while (reader->read(packet)) read += packet.events.size();
  const double speed = 1e-6 * static_cast<double>(read) / (test::processCpu_s() - begin);
  const bool good = read == written && (!row.packed || speed >= least);
  fmt::print("| {} | {:.1f} | {:.2f} | {} |\n", row.name, speed,
             static_cast<double>(sizeOf(path)) / static_cast<double>(written),
             good              ? "ok"
             : read != written ? fmt::format("{} of {} events", read, written)
                               : fmt::format("below {}", least));
  std::fflush(stdout);
  std::filesystem::remove_all(path);
  return good;
}

}  // namespace

int run(int argc, char** argv) {
  CommandLine app("Decoding speed per format.");
  std::filesystem::path scenario_file, folder = std::filesystem::temp_directory_path();
  double duration_s = 17.0, least = 20.0;
  app.option("SCENARIO", scenario_file, "Scenario file").required();
  app.option("--duration", duration_s,
             "Duration of the recording, s; 17 s of davis346 are 20 million events");
  app.option("--least", least, "Required speed of packed formats, million events/s");
  app.option("--folder", folder, "Folder for the files, which are removed at the end");
  if (!app.parse(argc, argv)) return 0;
  Scenario scenario = readScenario(scenario_file);
  scenario.duration_s = duration_s;
  const std::vector<Event> events = simulatedEvents(scenario);
  fmt::print("{} events\n\n| format | million events/s per core | bytes per event | |\n|---|---|---|---|\n",
             events.size());
  bool good = true;
  const std::filesystem::path path = folder / fmt::format("evical_formats_{}", getpid());
  const Rows rows(events, scenario.cameras.front().intrinsics.resolution_px);
  for (const Row& row : rows.list()) good = measure(row, path, events.size(), least) && good;
  return good ? 0 : 1;
}

}  // namespace evical::benchmarks::formats
