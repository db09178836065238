#include "core/pipeline/pass/session_recording.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/data/unfit_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace evical {
namespace {

constexpr std::array kCameraStreams = {StreamType::Events, StreamType::Frames, StreamType::Points};
constexpr std::array kImuStreams = {StreamType::Imu};

// Calls visit(items) with what the packet holds of each kind.
template <class SomePacket, class Visitor>
void forEachKind(SomePacket& packet, Visitor&& visit) {
  visit(packet.events);
  visit(packet.imu_samples);
  visit(packet.frames);
  visit(packet.points);
}

std::int64_t firstTime_ns(const SensorPacket& packet) {
  std::int64_t time_ns = 0;
  forEachKind(packet, [&](const auto& items) {
    if (!items.empty()) time_ns = items.front().time_ns;
  });
  return time_ns;
}

}  // namespace

std::int64_t SessionRecording::Source::time_ns() const {
  return finished ? std::numeric_limits<std::int64_t>::max() : firstTime_ns(next);
}

SessionRecording::SessionRecording(const Session& session, std::stop_token stop)
    : session_(session), stop_(std::move(stop)) {
  for (const SessionCamera& camera : session.cameras)
    addSensor(camera.recording, camera.stream, kCameraStreams);
  for (const SessionImu& imu : session.imus) addSensor(imu.recording, imu.joinedStream(), kImuStreams);
  gates_.resize(places_.size());
  for (Source& source : sources_) {
    source.reader->select(source.selected);
    advance(source);
  }
  checkTimed();
  checkClocks();
  const auto earliest =
      std::min_element(sources_.begin(), sources_.end(),
                       [](const Source& a, const Source& b) { return a.time_ns() < b.time_ns(); });
  if (!earliest->finished) start_ns_ = earliest->time_ns();
}

std::size_t SessionRecording::sourceOf(const std::filesystem::path& path) {
  const auto same = [&](const Source& source) {
    std::error_code ignored;
    return source.path == path || std::filesystem::equivalent(source.path, path, ignored);
  };
  const auto found = std::find_if(sources_.begin(), sources_.end(), same);
  if (found != sources_.end()) return static_cast<std::size_t>(found - sources_.begin());
  Source& source = sources_.emplace_back();
  source.path = path;
  source.reader = withSeparateImus(openRecording(path, columnNames(path)), separateImus(path));
  return sources_.size() - 1;
}

template <class Sensor>
bool SessionRecording::isIn(const std::filesystem::path& path, const Sensor& sensor) const {
  const std::filesystem::path& own = sensor.recording.empty() ? session_.recording : sensor.recording;
  std::error_code ignored;
  return own == path || std::filesystem::equivalent(own, path, ignored);
}

// What the session says of the tables in this recording.
ColumnNames SessionRecording::columnNames(const std::filesystem::path& path) const {
  ColumnNames names;
  const auto add = [&](const auto& sensor, const std::string& stream) {
    if (!stream.empty() && !sensor.columns.empty() && isIn(path, sensor)) names[stream] = sensor.columns;
  };
  for (const SessionCamera& camera : session_.cameras) add(camera, camera.stream);
  for (const SessionImu& imu : session_.imus)
    for (const std::string& stream : {imu.stream, imu.accelerometer_stream}) add(imu, stream);
  return names;
}

std::vector<SeparateImu> SessionRecording::separateImus(const std::filesystem::path& path) const {
  std::vector<SeparateImu> imus;
  for (const SessionImu& imu : session_.imus)
    if (!imu.accelerometer_stream.empty() && isIn(path, imu))
      imus.push_back({imu.stream, imu.accelerometer_stream});
  return imus;
}

void SessionRecording::addSensor(const std::filesystem::path& own_recording, const std::string& stream,
                                 std::span<const StreamType> types) {
  const std::filesystem::path& path = own_recording.empty() ? session_.recording : own_recording;
  Place place{sourceOf(path), 0};
  Source& source = sources_[place.source];
  try {
    place.stream = findStream(*source.reader, stream, types);
  } catch (const CalibrationError& error) {
    std::string problem = error.problem();
    for (const RecordingFault& fault : source.reader->faults())  // perhaps the stream was in what is lost
      problem += (problem.ends_with('.') ? " " : ". ") + fault.text;
    if (problem.ends_with('.')) problem.pop_back();
    throw badInput(fmt::format("{}: {}", path.string(), error.place()), problem, error.advice());
  }
  source.selected.push_back(place.stream);
  source.sensors.push_back(places_.size());
  places_.push_back(place);
}

void SessionRecording::checkTimed() const {
  if (session_.cameras.size() == 1 && session_.imus.empty()) return;
  for (std::size_t camera = 0; camera < session_.cameras.size(); ++camera) {
    if (info(camera).timed) continue;
    throw badInput(
        session_.cameras[camera].name,
        "its pictures have no times, so nothing can be calibrated against them",
        "Name them by their times in ns, or give a data.csv as EuRoC has it; for its intrinsics alone "
        "there is 'evical intrinsics'");
  }
}

void SessionRecording::checkClocks() const {
  constexpr double kFurthestStarts_s = 3600.0;
  const Source& first = sources_.front();
  for (const Source& source : sources_) {
    if (first.finished || source.finished) continue;
    const double apart_s = secondsSince(source.time_ns(), first.time_ns());
    if (std::abs(apart_s) < kFurthestStarts_s) continue;
    throw badInput(
        source.path.string(),
        fmt::format(
            "its clock has nothing to do with that of {}: it starts at {:.3f} s, the other at {:.3f} s",
            first.path.string(), secondsSince(0, source.time_ns()), secondsSince(0, first.time_ns())),
        fmt::format("Give clock_offset_s for its streams, what to add to their times: {:.3f} if both "
                    "recordings began "
                    "at the same moment, and prior.time_offset_search_s as large as that is uncertain",
                    apart_s));
  }
}

const StreamInfo& SessionRecording::info(std::size_t sensor) const {
  return sources_[places_[sensor].source].reader->streams()[places_[sensor].stream];
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
  const Resolution stated = info(camera).resolution_px;
  if (lens && stated.known() && lens->resolution_px.known() && lens->resolution_px != stated) {
    throw badInput(own.name,
                   fmt::format("its intrinsics are for {} x {} px, but the recording is of {} x {}",
                               lens->resolution_px.width_px, lens->resolution_px.height_px, stated.width_px,
                               stated.height_px),
                   "Use intrinsics of this camera at this resolution, or leave them out to calibrate them");
  }
  if (own.resolution_px.known()) return own.resolution_px;
  if (stated.known()) return stated;
  if (lens && lens->resolution_px.known()) return lens->resolution_px;
  if (info(camera).type == StreamType::Frames) return {};  // the first that is decoded tells
  throw badInput(own.name, "the recording does not say the sensor's resolution",
                 "Give resolution_px: [width, height] for this camera in the session");
}

bool SessionRecording::read(SensorPacket& packet) {
  const auto behind =
      std::min_element(sources_.begin(), sources_.end(),
                       [](const Source& a, const Source& b) { return a.time_ns() < b.time_ns(); });
  if (behind->finished) return false;
  std::swap(packet, behind->next);
  advance(*behind);
  return true;
}

// The next packet that holds something.
void SessionRecording::advance(Source& source) {
  while (!source.read_out) {
    source.read_out = stop_.stop_requested() || !source.reader->read(source.raw);
    if (source.read_out) break;
    if (source.raw.empty()) continue;
    const auto found = std::find(source.selected.begin(), source.selected.end(), source.raw.stream);
    source.next.sensor = source.sensors[static_cast<std::size_t>(found - source.selected.begin())];
    bringHome(source.raw, source.next);
    letIn(source.next);
    if (!source.next.empty()) return;
  }
  source.finished = !flushNext(source);
}

// What a sensor's stamps were waiting for has not come.
bool SessionRecording::flushNext(Source& source) {
  while (source.flushed < source.sensors.size()) {
    source.next.sensor = source.sensors[source.flushed++];
    Gate& gate = gates_[source.next.sensor];
    gate.events.finish(source.next.events);
    gate.samples.finish(source.next.imu_samples);
    gate.frames.finish(source.next.frames);
    gate.points.finish(source.next.points);
    if (!source.next.empty()) return true;
  }
  return false;
}

void SessionRecording::letIn(SensorPacket& packet) {
  Gate& gate = gates_[packet.sensor];
  for (const ImuSample& sample : packet.imu_samples) {
    if (!isMeasurable(sample) && gate.immeasurable++ == 0) gate.immeasurable_ns = sample.time_ns;
  }
  std::erase_if(packet.imu_samples, [](const ImuSample& sample) { return !isMeasurable(sample); });
  gate.events.filter(packet.events);
  gate.samples.filter(packet.imu_samples);
  gate.frames.filter(packet.frames);
  gate.points.filter(packet.points);
}

// Units and clock; the storage changes hands.
void SessionRecording::bringHome(Packet& raw, SensorPacket& packet) {
  const bool is_camera = packet.sensor < session_.cameras.size();
  const std::size_t imu = packet.sensor - session_.cameras.size();
  std::swap(packet.events, raw.events);
  std::swap(packet.frames, raw.frames);
  std::swap(packet.points, raw.points);
  packet.imu_samples.clear();
  if (!is_camera) {
    const StreamInfo& stream = info(packet.sensor);
    toSi(raw.imu_samples, session_.imus[imu].acceleration_unit.value_or(stream.acceleration_unit),
         session_.imus[imu].angular_rate_unit.value_or(stream.angular_rate_unit), packet.imu_samples);
    for (ImuSample& sample : packet.imu_samples) {
      // A message's own statement of what it measured counts only if the session names separate streams.
      if (session_.imus[imu].accelerometer_stream.empty()) sample.measured_by = MeasuredBy::Both;
      sample.angular_rate_rad_s = readAs(session_.imus[imu].gyroscope_axes, sample.angular_rate_rad_s);
      sample.specific_force_m_s2 = readAs(session_.imus[imu].accelerometer_axes, sample.specific_force_m_s2);
    }
  }
  setClock(packet);
}

// What the session says of the sensor's clock: its rate, and how far it is off.
void SessionRecording::setClock(SensorPacket& packet) {
  const bool is_camera = packet.sensor < session_.cameras.size();
  const std::size_t imu = packet.sensor - session_.cameras.size();
  const double offset_s =
      is_camera ? session_.cameras[packet.sensor].clock_offset_s : session_.imus[imu].clock_offset_s;
  const double scale =
      is_camera ? session_.cameras[packet.sensor].clock_scale : session_.imus[imu].clock_scale;
  if (offset_s == 0.0 && scale == 1.0) return;
  const std::int64_t offset_ns = nanosecondsFrom(offset_s);
  std::optional<std::int64_t>& first_ns = gates_[packet.sensor].first_ns;
  const std::string& name = is_camera ? session_.cameras[packet.sensor].name : session_.imus[imu].name;
  forEachKind(packet, [&](auto& items) {
    for (auto& item : items) {
      if (!first_ns) first_ns = item.time_ns;
      const double since_ns = scale * static_cast<double>(item.time_ns - *first_ns);
      if (scale != 1.0 && std::abs(since_ns) < static_cast<double>(kLatestTime_ns))
        item.time_ns = *first_ns + std::llround(since_ns);
      if (!__builtin_add_overflow(item.time_ns, offset_ns, &item.time_ns) && isTime(item.time_ns)) continue;
      throw badInput(
          name,
          "with clock_offset_s and clock_scale its times are centuries away from those of any recording",
          "Correct these two in the session");
    }
  });
}

double SessionRecording::fractionRead() const {
  double sum = 0.0;
  for (const Source& source : sources_) sum += source.finished ? 1.0 : source.reader->fractionRead();
  return sum / static_cast<double>(sources_.size());
}

std::vector<RecordingFault> SessionRecording::faults() const {
  std::vector<RecordingFault> all;
  for (std::size_t sensor = 0; sensor < gates_.size(); ++sensor) addFaults(sensor, all);
  for (const Source& source : sources_)
    all.insert(all.end(), source.reader->faults().begin(), source.reader->faults().end());
  return all;
}

void SessionRecording::addFaults(std::size_t sensor, std::vector<RecordingFault>& faults) const {
  const std::string& stream = info(sensor).name;
  const Gate& gate = gates_[sensor];
  const auto sayStrays = [&](const auto& filter, const char* items) {
    if (filter.strays() == 0) return;
    const double away_s = secondsSince(filter.strayFrom_ns(), filter.strayTime_ns());
    faults.push_back(
        {stream, FaultKind::Corrupt, secondsSince(start_ns_, filter.strayFrom_ns()),
         fmt::format("{}: {} {} left out, whose time stamps are far from those around them (the first "
                     "is {:.3f} s {}, at {:.3f} s)",
                     stream, filter.strays(), items, std::abs(away_s), away_s < 0.0 ? "behind" : "ahead",
                     secondsSince(start_ns_, filter.strayFrom_ns()))});
  };
  sayStrays(gate.events, "events");
  sayStrays(gate.samples, "IMU samples");
  sayStrays(gate.frames, "frames");
  sayStrays(gate.points, "points");
  if (gate.immeasurable == 0) return;
  const double at_s = secondsSince(start_ns_, gate.immeasurable_ns);
  faults.push_back(
      {stream, FaultKind::NotFinite, at_s,
       fmt::format("{}: {} IMU samples left out, whose values are no numbers, or none that a sensor "
                   "measures (the first at {:.3f} s)",
                   stream, gate.immeasurable, at_s)});
}

}  // namespace evical
