#include "core/pipeline/simulation.h"

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/new_folder.h"
#include "core/pipeline/simulated_cameras.h"
#include "core/recording/recording_reader.h"
#include "core/recording/recording_writer.h"
#include "core/synthetic/imu_simulator.h"
#include "core/synthetic/scenario_yaml.h"

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <system_error>
#include <vector>

namespace evical {
namespace {

std::vector<StreamInfo> streamsOf(const Scenario& scenario) {
  std::vector<StreamInfo> streams;
  for (const SimulatedCamera& camera : scenario.cameras) {
    StreamInfo info;
    info.name = camera.stream;
    info.type = StreamType::Events;
    info.resolution_px = camera.intrinsics.resolution_px;
    streams.push_back(info);
  }
  for (const SimulatedImu& imu : scenario.imus) {
    StreamInfo info;
    info.name = imu.stream;
    info.type = StreamType::Imu;
    streams.push_back(info);
  }
  return streams;
}

// IMU samples go out alongside the events, as a recorder would write them.
class ImuFeed {
 public:
  ImuFeed(std::size_t stream, std::vector<ImuSample> samples)
      : stream_(stream), samples_(std::move(samples)) {}

  void writeUntil(std::int64_t time_ns, RecordingWriter& writer) {
    const std::size_t begin = next_;
    while (next_ < samples_.size() && samples_[next_].time_ns <= time_ns) ++next_;
    if (next_ > begin)
      writer.write(stream_, std::span<const ImuSample>(samples_).subspan(begin, next_ - begin));
  }
  void writeRest(RecordingWriter& writer) {
    if (next_ < samples_.size()) writer.write(stream_, std::span<const ImuSample>(samples_).subspan(next_));
    next_ = samples_.size();
  }
  std::size_t size() const { return samples_.size(); }

 private:
  std::size_t stream_;
  std::vector<ImuSample> samples_;
  std::size_t next_ = 0;
};

// What the sensors' streams are called in the recording: not every format keeps names.
template <class Sensors>
void takeNames(const RecordingReader& reader, StreamType type, Sensors& sensors) {
  std::vector<std::string> names;
  for (const StreamInfo& stream : reader.streams())
    if (stream.type == type) names.push_back(stream.name);
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const bool kept = std::find(names.begin(), names.end(), sensors[i].stream) != names.end();
    if (!kept && i < names.size()) sensors[i].stream = names[i];
  }
}

// What there is of a recording, should its session not come to be.
std::vector<std::filesystem::path> filesOf(const std::filesystem::path& recording) {
  if (!std::filesystem::is_directory(recording)) return {recording};
  std::vector<std::filesystem::path> files;
  for (const char* name : {"events.txt", "imu.txt", "events.csv", "imu.csv"})
    files.push_back(recording / name);
  return files;
}

// A recording without its session and truth is of no use.
void writeTexts(const std::vector<FileContent>& texts, const std::vector<std::filesystem::path>& recordings) {
  try {
    writeFilesWhole(texts);
  } catch (...) {
    std::error_code ignored;
    for (const std::filesystem::path& recording : recordings) std::filesystem::remove(recording, ignored);
    throw;
  }
}

void writeRecording(const Scenario& scenario, RecordingWriter& writer, SimulationSummary& summary,
                    const RunContext& context) {
  std::vector<ImuFeed> feeds;
  for (std::size_t k = 0; k < scenario.imus.size(); ++k) {
    feeds.emplace_back(scenario.cameras.size() + k, simulateImu(scenario, k));
    summary.imu_samples += feeds.back().size();
  }
  simulateCameras(
      scenario,
      [&](std::size_t camera, EventSpan events) {
        for (ImuFeed& feed : feeds) feed.writeUntil(events.back().time_ns, writer);
        writer.write(camera, events);
        summary.events += events.size();
      },
      context);
  for (ImuFeed& feed : feeds) feed.writeRest(writer);
  writer.finish();
}

}  // namespace

SimulationSummary simulate(const Scenario& scenario, const std::filesystem::path& folder,
                           const RunContext& context, const std::string& format_name) {
  const bool text = scenario.format == SimulatedFormat::Text;
  const RecordingFormat& format = recordingFormat(!format_name.empty() ? format_name : text ? "text" : "bag");
  const NewFolder new_folder(folder);
  SimulationSummary summary;
  const std::string file = format.isFolder() ? "." : std::string("recording") + format.extension;
  summary.recording = format.isFolder() ? folder : folder / file;
  summary.session = folder / "session.yaml";
  summary.truth = folder / "truth.yaml";
  context.progress.stageStarted("simulate");
  const std::unique_ptr<RecordingWriter> writer =
      createRecording(summary.recording, format.name, streamsOf(scenario));
  writeRecording(scenario, *writer, summary, context);
  Scenario named = scenario;
  const std::unique_ptr<RecordingReader> reader = openRecording(summary.recording);
  takeNames(*reader, StreamType::Events, named.cameras);
  takeNames(*reader, StreamType::Imu, named.imus);
  writeTexts({{summary.session, sessionYaml(named, file)}, {summary.truth, truthYaml(scenario)}},
             filesOf(summary.recording));
  return summary;
}

}  // namespace evical
