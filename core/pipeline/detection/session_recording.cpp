#include "core/pipeline/detection/session_recording.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/base/number.h"
#include "core/base/time.h"
#include "core/frames/gray_image.h"
#include "core/recording/joined_reader.h"
#include "core/recording/separate_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace evical {
namespace {

constexpr std::array kCameraStreams = {StreamType::Events, StreamType::Frames, StreamType::Points};
constexpr std::array kImuStreams = {StreamType::Imu};

// Replaces the frame by raw pixels. A frame that cannot be decoded stays, since its user reports it.
void unmirrorFrame(Mirroring mirroring, Frame& frame) {
  GrayImage image;
  try {
    image = decodeFrame(frame, "frame");
  } catch (const CalibrationError&) {
    return;
  }
  frame.format = FrameFormat::Gray8;
  frame.size_px = mirroredSize(mirroring, image.size_px);
  frame.row_bytes = static_cast<std::size_t>(frame.size_px.width_px);
  frame.bytes.resize(image.pixels.size());
  for (int row = 0; row < frame.size_px.height_px; ++row)
    for (int col = 0; col < frame.size_px.width_px; ++col) {
      int x = col, y = row;
      mirrorPoint(mirroring, image.size_px, x, y);
      frame.bytes[static_cast<std::size_t>(row) * frame.row_bytes + static_cast<std::size_t>(col)] =
          image.pixels[static_cast<std::size_t>(y * image.size_px.width_px + x)];
    }
}

std::filesystem::path fileAt(const std::filesystem::path& path) {
  std::error_code ignored;
  std::filesystem::path whole = std::filesystem::canonical(path, ignored);
  return ignored ? path : whole;
}

std::filesystem::path accelerometerFile(const SessionCamera&) {
  return {};
}
std::filesystem::path accelerometerFile(const SessionImu& imu) {
  return imu.accelerometer_recording.empty() ? std::filesystem::path() : fileAt(imu.accelerometer_recording);
}

}  // namespace

std::string reversalNote(const SessionCamera& camera) {
  const Mirroring mirroring = camera.mirrored.value_or(Mirroring::None);
  if (mirroring == Mirroring::None) return {};
  return fmt::format(
      "{}: the session states that its image is mirrored ({}), which is reversed on reading; reverse "
      "it before using this result, too",
      camera.name, kMirroringNames[static_cast<std::size_t>(mirroring)]);
}

std::unique_ptr<RecordingReader> openBoth(const std::filesystem::path& gyroscope,
                                          const std::filesystem::path& accelerometer,
                                          const ColumnNames& names) {
  std::vector<JoinedReader::Part> parts;
  const std::string own_name = accelerometerTable(gyroscope, accelerometer);
  for (const auto& [file, name] :
       {std::pair{gyroscope, gyroscope.filename().string()}, std::pair{accelerometer, own_name}}) {
    const auto own = names.find(name);
    const ColumnNames columns =
        own == names.end() ? ColumnNames{} : ColumnNames{{file.filename().string(), own->second}};
    parts.push_back({openRecording(file, columns), name == own_name && name != file.filename() ? name : ""});
  }
  return std::make_unique<JoinedReader>(std::move(parts));
}

SessionRecording::SessionRecording(const Session& session, std::stop_token stop,
                                   const std::shared_ptr<Growth>& growth)
    : session_(session), streams_(stop) {
  const StopWaiting until_stop(std::move(stop));
  for (const SessionCamera& camera : session.cameras)
    addSensor("cameras", camera, camera.stream, kCameraStreams);
  for (const SessionImu& imu : session.imus) addSensor("imus", imu, imu.joinedStream(), kImuStreams);
  if (growth)
    for (const MergedStreams::File& file : streams_.files()) static_cast<void>(file.reader->follow(growth));
  start_ns_ = streams_.begin(isCameraAlone()).value_or(0);
  checkTimed();
  streams_.checkClocks([](double first_later_s) {
    return fmt::format(
        "Give clock_offset_s for its streams, which is added to their times: {:.3f} if both recordings began "
        "at the same moment. Set prior.time_offset_search_s to the uncertainty of this value",
        first_later_s);
  });
}

template <class Sensor>
SessionRecording::Source SessionRecording::sourceOf(const Sensor& sensor) const {
  Source source{fileAt(sensor.recording.empty() ? session_.recording : sensor.recording),
                accelerometerFile(sensor),
                {}};
  const auto differs = [&](const auto& other) {
    const std::filesystem::path& file = other.recording.empty() ? session_.recording : other.recording;
    return other.stream == sensor.stream && other.columns != sensor.columns && fileAt(file) == source.file;
  };
  if (std::ranges::any_of(session_.cameras, differs) || std::ranges::any_of(session_.imus, differs))
    source.columns = sensor.columns;
  return source;
}

template <class Sensor>
std::size_t SessionRecording::fileOf(const Sensor& sensor) {
  Source source = sourceOf(sensor);
  const auto found = std::ranges::find(sources_, source);
  if (found != sources_.end()) return static_cast<std::size_t>(found - sources_.begin());
  const ColumnNames names = columnNames(source);
  const std::filesystem::path& file = sensor.recording.empty() ? session_.recording : sensor.recording;
  std::unique_ptr<RecordingReader> reader = source.accelerometer_file.empty()
                                                ? openRecording(file, names)
                                                : openBoth(source.file, source.accelerometer_file, names);
  streams_.files().push_back({file, withSeparateImus(std::move(reader), separateImus(source))});
  sources_.push_back(std::move(source));
  return sources_.size() - 1;
}

// The session's column names for tables in this source.
ColumnNames SessionRecording::columnNames(const Source& source) const {
  ColumnNames names;
  const auto add = [&](const auto& sensor, const std::string& stream, const std::string& columns) {
    if (!stream.empty() && !columns.empty() && sourceOf(sensor) == source) names[stream] = columns;
  };
  for (const SessionCamera& camera : session_.cameras) add(camera, camera.stream, camera.columns);
  for (const SessionImu& imu : session_.imus) {
    add(imu, imu.stream, imu.columns);
    add(imu, imu.accelerometer_stream,
        imu.accelerometer_columns.empty() ? imu.columns : imu.accelerometer_columns);
  }
  return names;
}

std::vector<SeparateImu> SessionRecording::separateImus(const Source& source) const {
  std::vector<SeparateImu> imus;
  for (const SessionImu& imu : session_.imus)
    if (!imu.accelerometer_stream.empty() && sourceOf(imu) == source)
      imus.push_back({imu.stream, imu.accelerometer_stream});
  return imus;
}

template <class Sensor>
void SessionRecording::addSensor(const char* section, const Sensor& sensor, const std::string& stream,
                                 std::span<const StreamType> types) {
  const std::filesystem::path& path = sensor.recording.empty() ? session_.recording : sensor.recording;
  const std::size_t place = fileOf(sensor);
  MergedStreams::File& file = streams_.files()[place];
  try {
    file.add(findStream(*file.reader, stream, types), places_.size(), sensor);
  } catch (const CalibrationError& error) {
    std::string problem = error.problem();
    for (const RecordingFault& fault : file.reader->faults())  // the stream may have been in the lost part
      problem += (problem.ends_with('.') ? " " : ". ") + fault.text;
    if (problem.ends_with('.')) problem.pop_back();
    throw badInput(fmt::format("{}: {}.{}.stream", path.string(), section, sensor.name),
                   fmt::format("'{}': {}", error.place(), problem), error.advice());
  }
  places_.emplace_back(place, file.streams.size() - 1);
}

bool SessionRecording::isCameraAlone() const {
  return session_.cameras.size() == 1 && session_.imus.empty();
}

void SessionRecording::checkTimed() const {
  if (isCameraAlone()) return;
  for (std::size_t camera = 0; camera < session_.cameras.size(); ++camera) {
    if (info(camera).timed) continue;
    throw badInput(session_.cameras[camera].name,
                   "its images have no timestamps, so other sensors cannot be calibrated relative to it",
                   "Use timestamps in ns as file names, or add a data.csv as in EuRoC. To calibrate only its "
                   "intrinsics, calibrate the camera " +
                       howTo(HowTo::CalibrateLens));
  }
}

const MergedStreams::Stream& SessionRecording::stream(std::size_t sensor) const {
  return streams_.files()[places_[sensor].first].streams[places_[sensor].second];
}

const StreamInfo& SessionRecording::info(std::size_t sensor) const {
  return streams_.files()[places_[sensor].first].info(stream(sensor));
}

CameraKind SessionRecording::kind(std::size_t camera) const {
  const StreamType type = this->camera(camera).type;
  return type == StreamType::Frames   ? CameraKind::Frames
         : type == StreamType::Points ? CameraKind::Points
                                      : CameraKind::Events;
}

Resolution SessionRecording::resolution_px(std::size_t camera) const {
  const SessionCamera& own = session_.cameras[camera];
  const std::optional<CameraIntrinsics>& lens = session_.sensor(camera).intrinsics;
  const Resolution stated = mirroredSize(own.mirrored.value_or(Mirroring::None), info(camera).resolution_px);
  if (lens && stated.known() && lens->resolution_px.known() && lens->resolution_px != stated) {
    throw badInput(own.name,
                   fmt::format("its intrinsics are for {} x {} px, but the recording has {} x {}",
                               lens->resolution_px.width_px, lens->resolution_px.height_px, stated.width_px,
                               stated.height_px),
                   "Use intrinsics of this camera at this resolution, or remove them to calibrate them");
  }
  if (own.resolution_px.known()) return own.resolution_px;
  if (stated.known()) return stated;
  if (lens && lens->resolution_px.known()) return lens->resolution_px;
  if (info(camera).type == StreamType::Frames) return {};  // known after the first one is decoded
  throw badInput(own.name, "the recording does not contain the sensor's resolution",
                 howTo(HowTo::GiveResolution));
}

// Everything else follows from wrong times, so it would be wrong advice.
void SessionRecording::checkTimes() const {
  for (std::size_t sensor = 0; sensor < places_.size(); ++sensor) {
    const MergedStreams::File& file = streams_.files()[places_[sensor].first];
    const MergedStreams::Stream& own = stream(sensor);
    if (own.numbered || own.clock_scale != 1.0) continue;
    for (const RecordingFault& fault : file.reader->faults()) {
      const bool wrong = fault.kind == FaultKind::Unit || fault.kind == FaultKind::SecondClock;
      if (!wrong || fault.stream != info(sensor).name) continue;
      throw badInput(fmt::format("{}: {}", file.path.string(), own.name),
                     fault.text.substr(0, fault.text.size() - 1),
                     "Write the recording again with right times");
    }
  }
}

bool SessionRecording::read(SensorPacket& packet) {
  if (!streams_.read(packet)) {
    if (!streams_.isStopped()) checkTimes();
    return false;
  }
  if (packet.sensor < session_.cameras.size()) unmirror(packet);
  return true;
}

void SessionRecording::unmirror(SensorPacket& packet) const {
  const Mirroring mirroring = session_.cameras[packet.sensor].mirrored.value_or(Mirroring::None);
  if (mirroring == Mirroring::None) return;
  for (Frame& frame : packet.frames) unmirrorFrame(mirroring, frame);
  if (packet.events.empty() && packet.points.empty()) return;
  const Resolution size_px = resolution_px(packet.sensor);
  for (Event& event : packet.events) mirrorPoint(mirroring, size_px, event.x_px, event.y_px);
  for (MeasuredPoint& point : packet.points) mirrorPoint(mirroring, size_px, point.x_px, point.y_px);
}

std::vector<RecordingFault> SessionRecording::faults() const {
  std::vector<RecordingFault> all;
  for (std::size_t sensor = 0; sensor < places_.size(); ++sensor) addFaults(sensor, all);
  streams_.addFaults(all);
  return all;
}

void SessionRecording::addFaults(std::size_t sensor, std::vector<RecordingFault>& faults) const {
  const std::string& stream = info(sensor).name;
  const MergedStreams::Stream& gate = this->stream(sensor);
  const auto at = [&](std::int64_t own_ns) {
    return secondsSince(start_ns_, gate.sessionTime_ns(own_ns).value_or(own_ns));
  };
  const auto noteStrays = [&](const auto& filter, const char* item) {
    if (filter.strays() == 0) return;
    const double away_s = secondsSince(filter.strayFrom_ns(), filter.strayTime_ns());
    faults.push_back(
        {stream, FaultKind::Corrupt, at(filter.strayFrom_ns()),
         fmt::format("{}: {} excluded, whose timestamps are far from neighbouring ones (the first is "
                     "{:.3f} s {}, at {:.3f} s)",
                     stream, counted(filter.strays(), item), std::abs(away_s),
                     away_s < 0.0 ? "behind" : "ahead", at(filter.strayFrom_ns()))});
  };
  noteStrays(gate.events, "event");
  noteStrays(gate.samples, "IMU sample");
  noteStrays(gate.frames, "frame");
  noteStrays(gate.points, "point");
  if (gate.immeasurable == 0) return;
  const double at_s = at(gate.immeasurable_ns);
  faults.push_back(
      {stream, FaultKind::NotFinite, at_s,
       fmt::format("{}: {} excluded, whose values are not finite or not plausible (the first at {:.3f} s)",
                   stream, counted(gate.immeasurable, "IMU sample"), at_s)});
}

bool SessionTimeRange::holds(std::int64_t time_ns) const {
  if (!session_.time_range_s) return true;
  const double time_s = secondsSince(start_ns_, time_ns);
  return time_s >= (*session_.time_range_s)[0] && time_s <= (*session_.time_range_s)[1];
}

bool SessionTimeRange::isOver(const SensorPacket& packet) {
  if (!session_.time_range_s) return false;
  const auto follow = [&](const auto& items) {
    if (!items.empty()) latest_ns_ = std::max(latest_ns_, items.back().time_ns);
  };
  follow(packet.events);
  follow(packet.imu_samples);
  follow(packet.frames);
  follow(packet.points);
  constexpr double kMargin_s = 1.0;  // larger than the disorder of packets in files
  const auto behind = [&](const auto& items) {
    return !items.empty() &&
           secondsSince(start_ns_, items.front().time_ns) > (*session_.time_range_s)[1] + kMargin_s;
  };
  behind_[packet.sensor] =
      behind(packet.events) || behind(packet.imu_samples) || behind(packet.frames) || behind(packet.points);
  return std::ranges::all_of(behind_, [](bool each) { return each; });
}

void SessionTimeRange::checkBegin() const {
  if (!session_.time_range_s) return;
  const double end_s = secondsSince(start_ns_, latest_ns_), begin_s = session_.time_range_s->front();
  if (begin_s <= end_s) return;
  throw badInput(
      session_.recording.string(),
      fmt::format("lasts {:.1f} s, but {} begins at {:g} s", end_s, howTo(HowTo::LimitTime), begin_s),
      "Give a range within the recording, in seconds since its start");
}

}  // namespace evical
