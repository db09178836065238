#include "core/pipeline/simulation.h"

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/pipeline/simulated_cameras.h"
#include "core/recording/recording_writer.h"
#include "core/synthetic/imu_simulator.h"
#include "core/synthetic/scenario_yaml.h"

#include <algorithm>
#include <memory>
#include <span>
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

// Takes the folder away again if it wasn't there before and nothing came of it.
class NewFolder {
 public:
  explicit NewFolder(const std::filesystem::path& folder)
      : folder_(folder), was_there_(std::filesystem::exists(folder)) {
    makeOutputFolder(folder);
  }
  ~NewFolder() {
    std::error_code ignored;
    if (!was_there_) std::filesystem::remove(folder_, ignored);  // only if empty
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

 private:
  std::filesystem::path folder_;
  bool was_there_;
};

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

}  // namespace

SimulationSummary simulate(const Scenario& scenario, const std::filesystem::path& folder,
                           const RunContext& context) {
  const NewFolder new_folder(folder);
  const bool text = scenario.format == SimulatedFormat::Text;
  SimulationSummary summary;
  summary.recording = text ? folder : folder / "recording.bag";
  summary.session = folder / "session.yaml";
  summary.truth = folder / "truth.yaml";
  context.progress.stageStarted("simulate");
  const std::unique_ptr<RecordingWriter> writer =
      text ? createText(folder, streamsOf(scenario))
           : createBag(summary.recording, streamsOf(scenario), false);
  std::vector<ImuFeed> feeds;
  for (std::size_t k = 0; k < scenario.imus.size(); ++k) {
    feeds.emplace_back(scenario.cameras.size() + k, simulateImu(scenario, k));
    summary.imu_samples += feeds.back().size();
  }
  simulateCameras(
      scenario,
      [&](std::size_t camera, EventSpan events) {
        for (ImuFeed& feed : feeds) feed.writeUntil(events.back().time_ns, *writer);
        writer->write(camera, events);
        summary.events += events.size();
      },
      context);
  for (ImuFeed& feed : feeds) feed.writeRest(*writer);
  writer->finish();
  writeTexts({{summary.session, sessionYaml(scenario, text ? "." : "recording.bag")},
              {summary.truth, truthYaml(scenario)}},
             text ? std::vector{folder / "events.txt", folder / "imu.txt"} : std::vector{summary.recording});
  return summary;
}

}  // namespace evical
