#include "core/pipeline/session_recording.h"

#include "core/base/error.h"
#include "core/base/time.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace evical {
namespace {

std::int64_t firstTime_ns(const SensorPacket& packet) {
  return packet.events.empty() ? packet.imu_samples.front().time_ns : packet.events.front().time_ns;
}

}  // namespace

std::int64_t SessionRecording::Source::time_ns() const {
  return finished ? std::numeric_limits<std::int64_t>::max() : firstTime_ns(next);
}

SessionRecording::SessionRecording(const Session& session) : session_(session) {
  for (const SessionCamera& camera : session.cameras)
    addSensor(camera.recording, camera.stream, StreamType::Events);
  for (const SessionImu& imu : session.imus) addSensor(imu.recording, imu.stream, StreamType::Imu);
  for (Source& source : sources_) {
    source.reader->select(source.selected);
    advance(source);
  }
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
  source.reader = openRecording(path);
  return sources_.size() - 1;
}

void SessionRecording::addSensor(const std::filesystem::path& own_recording, const std::string& stream,
                                 StreamType type) {
  const std::filesystem::path& path = own_recording.empty() ? session_.recording : own_recording;
  Place place{sourceOf(path), 0};
  Source& source = sources_[place.source];
  try {
    place.stream = findStream(*source.reader, stream, type);
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

Resolution SessionRecording::resolution_px(std::size_t camera) const {
  const SessionCamera& own = session_.cameras[camera];
  const Resolution stated = info(camera).resolution_px;
  if (own.intrinsics && stated.known() && own.intrinsics->resolution_px.known() &&
      own.intrinsics->resolution_px != stated) {
    throw badInput(own.name,
                   fmt::format("its intrinsics are for {} x {} px, but the recording is of {} x {}",
                               own.intrinsics->resolution_px.width_px,
                               own.intrinsics->resolution_px.height_px, stated.width_px, stated.height_px),
                   "Use intrinsics of this camera at this resolution, or leave them out to calibrate them");
  }
  if (own.resolution_px.known()) return own.resolution_px;
  if (stated.known()) return stated;
  if (own.intrinsics && own.intrinsics->resolution_px.known()) return own.intrinsics->resolution_px;
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
  do {
    source.finished = !source.reader->read(source.raw);
  } while (!source.finished && source.raw.events.empty() && source.raw.imu_samples.empty());
  if (source.finished) return;
  const auto found = std::find(source.selected.begin(), source.selected.end(), source.raw.stream);
  source.next.sensor = source.sensors[static_cast<std::size_t>(found - source.selected.begin())];
  bringHome(source.raw, source.next);
}

// Units and clock; the events' storage changes hands.
void SessionRecording::bringHome(Packet& raw, SensorPacket& packet) const {
  const bool is_camera = packet.sensor < session_.cameras.size();
  const std::size_t imu = packet.sensor - session_.cameras.size();
  std::swap(packet.events, raw.events);
  packet.imu_samples.clear();
  if (!is_camera) {
    const StreamInfo& stream = info(packet.sensor);
    toSi(raw.imu_samples, session_.imus[imu].acceleration_unit.value_or(stream.acceleration_unit),
         session_.imus[imu].angular_rate_unit.value_or(stream.angular_rate_unit), packet.imu_samples);
  }
  const double offset_s =
      is_camera ? session_.cameras[packet.sensor].clock_offset_s : session_.imus[imu].clock_offset_s;
  if (const std::int64_t offset_ns = nanosecondsFrom(offset_s); offset_ns != 0) {
    for (Event& event : packet.events) event.time_ns += offset_ns;
    for (ImuSample& sample : packet.imu_samples) sample.time_ns += offset_ns;
  }
}

double SessionRecording::fractionRead() const {
  double sum = 0.0;
  for (const Source& source : sources_) sum += source.finished ? 1.0 : source.reader->fractionRead();
  return sum / static_cast<double>(sources_.size());
}

std::vector<RecordingFault> SessionRecording::faults() const {
  std::vector<RecordingFault> all;
  for (const Source& source : sources_)
    all.insert(all.end(), source.reader->faults().begin(), source.reader->faults().end());
  return all;
}

}  // namespace evical
