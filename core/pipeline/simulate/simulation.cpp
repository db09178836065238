#include "core/pipeline/simulate/simulation.h"

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/base/how_to.h"
#include "core/base/time.h"
#include "core/export/export_target.h"
#include "core/frames/gray_image.h"
#include "core/numerics/angles.h"
#include "core/pipeline/detection/bounded_queue.h"
#include "core/recording/recording_writer.h"
#include "core/synthetic/drive_simulator.h"
#include "core/synthetic/event_simulator.h"
#include "core/synthetic/frame_simulator.h"
#include "core/synthetic/imu_simulator.h"
#include "core/synthetic/scenario_yaml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace evical {
namespace {

std::vector<StreamInfo> streamsOf(const Scenario& scenario) {
  std::vector<StreamInfo> streams;
  for (const SimulatedCamera& camera : scenario.cameras) {
    if (camera.frames) continue;
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

// Writes IMU samples between the events, as a recorder does.
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

// Sets the stream names that the format uses, in the order of streamsOf.
void takeNames(const std::vector<std::string>& names, Scenario& scenario) {
  auto name = names.begin();
  for (SimulatedCamera& camera : scenario.cameras)
    if (!camera.frames) camera.stream = *name++;
  for (SimulatedImu& imu : scenario.imus) imu.stream = *name++;
}

// Writes directly: the folder is a temporary one.
void writePicture(const std::filesystem::path& path, const std::string& content) {
  std::ofstream file(path, std::ios::binary);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.flush();
  if (!file)
    throw calibrationFailed(path.string(), fmt::format("cannot be written: {}", std::strerror(errno)),
                            "Check the space on the disk");
}

// Frames of all frame cameras: files named by their stamps in ns, as Kalibr wants them.
// `start_ns`: the start of the other streams in their files.
void writeFrames(const Scenario& scenario, std::int64_t start_ns, const std::filesystem::path& folder,
                 SimulationSummary& summary, const RunContext& context) {
  for (std::size_t k = 0; k < scenario.cameras.size(); ++k) {
    if (!scenario.cameras[k].frames) continue;
    const std::filesystem::path own = folder / kFramesFolder / scenario.cameras[k].stream;
    std::filesystem::create_directories(own);
    const int quality = scenario.cameras[k].frames->jpeg_quality;
    simulateFrames(
        scenario, k,
        [&](const Frame& frame) {
          const bool lossless = quality == 0;
          writePicture(own / fmt::format("{}.{}", frame.time_ns - scenario.start_ns + start_ns,
                                         lossless ? "png" : "jpg"),
                       lossless ? encodedPng(frame) : encodedJpeg(frame, quality));
          ++summary.frames;
        },
        context);
  }
}

// Temporary folder for all files until they are complete; inside the target folder, so that they can be
// moved.
class TransactionalFolder {
 public:
  explicit TransactionalFolder(const std::filesystem::path& folder) {
    removeLitterOf(folder / kPrefix);
    std::string path = (folder / kPrefix).string() + ".part.XXXXXX";
    if (::mkdtemp(path.data()) == nullptr)
      throw calibrationFailed(folder.string(), fmt::format("cannot be written to: {}", std::strerror(errno)),
                              "Check the folder, its permissions and the space on the disk");
    folder_ = path;
  }
  ~TransactionalFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  TransactionalFolder(const TransactionalFolder&) = delete;
  TransactionalFolder& operator=(const TransactionalFolder&) = delete;

  const std::filesystem::path& folder() const { return folder_; }

  // Moves all files to `folder`, these two last.
  void moveTo(const std::filesystem::path& folder, const std::string& truth,
              const std::string& session) const {
    std::vector<FileMove> moves;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      const std::filesystem::path name = entry.path().filename();
      if (name != truth && name != session) moves.push_back({entry.path(), folder / name});
    }
    moves.push_back({folder_ / truth, folder / truth});
    moves.push_back({folder_ / session, folder / session});
    moveFilesWhole(moves);
  }

 private:
  static constexpr const char* kPrefix = ".simulation";
  std::filesystem::path folder_;
};

// `imu_writer`: the same writer, or one for a separate file with the IMUs.
void writeRecording(const Scenario& scenario, RecordingWriter& writer, RecordingWriter& imu_writer,
                    SimulationSummary& summary, const RunContext& context) {
  const bool apart = &writer != &imu_writer;
  std::vector<ImuFeed> feeds;
  std::vector<std::size_t> streams;  // by camera; unused for frame cameras
  std::size_t next = 0;
  for (const SimulatedCamera& camera : scenario.cameras) {
    streams.push_back(next);
    if (!camera.frames) ++next;
  }
  for (std::size_t k = 0; k < scenario.imus.size(); ++k) {
    feeds.emplace_back(apart ? k : next + k, simulateImu(scenario, k));
    summary.imu_samples += feeds.back().size();
  }
  simulateCameras(
      scenario,
      [&](std::size_t camera, EventSpan events) {
        for (ImuFeed& feed : feeds) feed.writeUntil(events.back().time_ns, imu_writer);
        writer.write(streams[camera], events);
        summary.events += events.size();
      },
      context);
  for (ImuFeed& feed : feeds) feed.writeRest(imu_writer);
  writer.finish();
  if (apart) imu_writer.finish();
}

// Writes the files of Prophesee cameras: the camera's file, and a separate table for the IMU.
void writeApart(const std::filesystem::path& made, const RecordingFormat& format, Scenario& named,
                SimulationSummary& summary, const RunContext& context) {
  std::vector<StreamInfo> events = streamsOf(named), imus;
  const auto is_imu = [](const StreamInfo& stream) { return stream.type == StreamType::Imu; };
  std::copy_if(events.begin(), events.end(), std::back_inserter(imus), is_imu);
  std::erase_if(events, is_imu);
  if (events.size() != 1)
    throw badInput(howTo(HowTo::Option, {"format"}) + " " + std::string(format.name),
                   fmt::format("supports events of one camera, but the scenario has {}", events.size()),
                   "Choose another format");
  const std::unique_ptr<RecordingWriter> writer = createRecording(made, format.name, events);
  const std::unique_ptr<RecordingWriter> table = createCsv(made.parent_path(), imus);
  writeRecording(named, *writer, *table, summary, context);
  std::vector<std::string> names = writer->streamNames();
  for (const std::string& name : table->streamNames()) names.push_back(name);
  takeNames(names, named);
}

}  // namespace

SimulationSummary simulate(const Scenario& scenario, const std::filesystem::path& folder,
                           const RunContext& context, const std::string& format_name) {
  const bool text = scenario.format == SimulatedFormat::Text;
  const RecordingFormat& format = recordingFormat(!format_name.empty() ? format_name : text ? "text" : "bag");
  const NewFolder new_folder(folder);
  const TransactionalFolder made_in(folder);
  SimulationSummary summary;
  const std::string file = format.isFolder() ? "." : std::string("recording") + format.extension;
  const std::filesystem::path made = format.isFolder() ? made_in.folder() : made_in.folder() / file;
  summary.recording = format.isFolder() ? folder : folder / file;
  summary.session = folder / "session.yaml";
  summary.truth = folder / "truth.yaml";
  context.progress.stageStarted("simulate");
  Scenario named = scenario;
  const std::vector<StreamInfo> streams = streamsOf(scenario);
  if (streams.empty()) {
    summary.recording = folder / kFramesFolder;
  } else if (format.one_camera) {
    // These files cannot contain absolute times. The names of frames need at least 12 digits.
    named.start_ns = 200 * kSecond_ns;
    writeApart(made, format, named, summary, context);
  } else {
    const std::unique_ptr<RecordingWriter> writer = createRecording(made, format.name, streams);
    writeRecording(scenario, *writer, *writer, summary, context);
    takeNames(writer->streamNames(), named);
  }
  writeFrames(scenario, named.start_ns, made_in.folder(), summary, context);
  writeFileWhole(made_in.folder() / "truth.yaml", truthYaml(scenario));
  writeFileWhole(made_in.folder() / "session.yaml",
                 sessionYaml(named, streams.empty() ? kFramesFolder : file,
                             format.one_camera && !streams.empty() ? "imu.csv" : ""));
  made_in.moveTo(folder, "truth.yaml", "session.yaml");
  return summary;
}

namespace {

constexpr std::size_t kQueuedPackets = 16;

struct Abandoned {};  // the receiver of the events has gone

class CameraThread {
 public:
  CameraThread(const Scenario& scenario, std::size_t camera, const RunContext& context, int threads)
      : queue_(kQueuedPackets), thread_([this, &scenario, camera, &context, threads] {
          try {
            simulateEvents(
                scenario, camera,
                [this](EventSpan events) {
                  if (!events.empty() && !queue_.push({events.begin(), events.end()})) throw Abandoned{};
                },
                context, threads);
          } catch (const Abandoned&) {
          } catch (...) {
            failure_ = std::current_exception();
          }
          queue_.close();
        }) {
    advance();
  }
  ~CameraThread() { queue_.close(); }
  CameraThread(const CameraThread&) = delete;
  CameraThread& operator=(const CameraThread&) = delete;

  EventSpan next() const { return next_ ? EventSpan(*next_) : EventSpan(); }
  std::int64_t time_ns() const {
    return next_ ? next_->front().time_ns : std::numeric_limits<std::int64_t>::max();
  }
  void advance() {
    next_ = queue_.pop();
    if (!next_ && failure_) std::rethrow_exception(failure_);
  }

 private:
  BoundedQueue<std::vector<Event>> queue_;
  std::optional<std::vector<Event>> next_;
  std::exception_ptr failure_;  // set before the queue closes
  std::jthread thread_;         // declared last: it uses the other members
};

}  // namespace

void simulateCameras(const Scenario& scenario,
                     const std::function<void(std::size_t camera, EventSpan events)>& sink,
                     const RunContext& context) {
  const int threads = scenario.cameras.size() == 1 ? 2 : 1;
  const RunContext quiet{silentProgress(), context.stop};
  std::vector<std::unique_ptr<CameraThread>> cameras;
  std::vector<std::size_t> indices;
  for (std::size_t k = 0; k < scenario.cameras.size(); ++k) {
    if (scenario.cameras[k].frames) continue;
    cameras.push_back(
        std::make_unique<CameraThread>(scenario, k, indices.empty() ? context : quiet, threads));
    indices.push_back(k);
  }
  while (!cameras.empty()) {
    const auto first = std::min_element(cameras.begin(), cameras.end(), [](const auto& a, const auto& b) {
      return a->time_ns() < b->time_ns();
    });
    const EventSpan events = (*first)->next();
    if (events.empty()) return;
    sink(indices[static_cast<std::size_t>(first - cameras.begin())], events);
    (*first)->advance();
  }
}

namespace {

ImuUncertainty sigmasOfCalibration(bool reference) {
  ImuUncertainty sigma;
  if (!reference) {
    sigma.rotation_std_rad.setConstant(0.01 * kRadPerDeg);
    sigma.translation_std_m.setConstant(2e-4);
    sigma.time_offset_std_s = 1e-5;
  }
  sigma.gyroscope_bias_std_rad_s.setConstant(2e-5);
  sigma.accelerometer_bias_std_m_s2.setConstant(2e-3);
  const Eigen::Matrix3d upper = Eigen::Matrix3d::Ones().triangularView<Eigen::Upper>();
  sigma.gyroscope_scale_misalignment_std = sigma.accelerometer_scale_misalignment_std = 2e-4 * upper;
  return sigma;
}

// Writes samples in time order, as a recorder does.
void writeSamples(const DriveScenario& scenario, RecordingWriter& writer, SimulationSummary& summary,
                  const RunContext& context) {
  std::vector<std::vector<ImuSample>> samples;
  for (std::size_t i = 0; i < scenario.imus.size(); ++i) {
    samples.push_back(simulateDriveImu(scenario, i));
    summary.imu_samples += samples.back().size();
    context.throwIfStopped();
  }
  constexpr std::int64_t kPart_ns = 10'000'000;
  std::vector<std::size_t> next(samples.size(), 0);
  std::uint64_t written = 0;
  for (std::int64_t until_ns = scenario.start_ns; written < summary.imu_samples; until_ns += kPart_ns) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const std::size_t begin = next[i];
      while (next[i] < samples[i].size() && samples[i][next[i]].time_ns <= until_ns) ++next[i];
      if (next[i] > begin)
        writer.write(i, std::span<const ImuSample>(samples[i]).subspan(begin, next[i] - begin));
      written += next[i] - begin;
    }
    context.throwIfStopped();
    context.progress.stageProgress(static_cast<double>(written) / static_cast<double>(summary.imu_samples));
  }
  writer.finish();
}

}  // namespace

NamedResult calibrationBefore(const DriveScenario& scenario) {
  NamedResult named;
  CalibrationResult result;
  named.reference = scenario.imus.front().name;
  for (const SimulatedImu& imu : scenario.imus) {
    SensorDescription known{imu.name, imu.stream};
    known.noise = {imu.gyroscope_density, imu.accelerometer_density, imu.gyroscope_walk,
                   imu.accelerometer_walk};
    known.rate_hz = imu.rate_hz;
    named.imus.push_back(known);
    result.uncertainty.imus.push_back(sigmasOfCalibration(result.state.imus.empty()));
    result.state.imus.push_back(imu);
  }
  result.imus.resize(scenario.imus.size());
  result.state.gravity_in_world_m_s2 = {0.0, 0.0, -scenario.gravity_m_s2};
  named.result = std::make_shared<const CalibrationResult>(std::move(result));
  return named;
}

SimulationSummary simulateDrive(const DriveScenario& scenario, const std::filesystem::path& folder,
                                const RunContext& context, const std::string& format_name) {
  const RecordingFormat& format = recordingFormat(format_name.empty() ? "bag" : format_name);
  std::vector<StreamInfo> streams;
  for (const SimulatedImu& imu : scenario.imus) {
    StreamInfo& stream = streams.emplace_back();
    stream.name = imu.stream;
    stream.type = StreamType::Imu;
  }
  const NewFolder new_folder(folder);
  SimulationSummary summary;
  summary.recording = format.isFolder() ? folder : folder / (std::string("recording") + format.extension);
  summary.session = folder / "calibration" / "result.yaml";
  summary.truth = folder / "truth.yaml";
  context.progress.stageStarted("simulate");
  NamedResult before = calibrationBefore(scenario);
  {
    const auto writer = createRecording(summary.recording, format.name, streams);
    const std::vector<std::string> names = writer->streamNames();
    for (std::size_t i = 0; i < names.size(); ++i) before.imus[i].stream = names[i];
    writeSamples(scenario, *writer, summary, context);
  }
  std::vector<FileContent> files;
  if (const std::string trajectory = driveTrajectoryCsv(scenario); !trajectory.empty())
    files.push_back({"trajectory.csv", trajectory});
  files.push_back({std::filesystem::path("calibration") / "result.yaml", resultYaml(before)});
  files.push_back({"truth.yaml", driveTruthYaml(scenario)});
  writeExportedFiles(folder, files);
  return summary;
}

}  // namespace evical
