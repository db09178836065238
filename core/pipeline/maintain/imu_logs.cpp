#include "core/pipeline/maintain/imu_logs.h"

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/time.h"
#include "core/data/unfit_samples.h"
#include "core/recording/separate_imu.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace evical {
namespace {

std::vector<std::string> namesOf(const NamedResult& before) {
  std::vector<std::string> names;
  for (const SensorDescription& imu : before.imus) names.push_back(imu.name);
  return names;
}

std::optional<std::size_t> onlyOne(const std::vector<std::size_t>& found) {
  return found.size() == 1 ? std::optional(found.front()) : std::nullopt;
}

}  // namespace

std::int64_t ImuLogs::Source::time_ns() const {
  return finished ? std::numeric_limits<std::int64_t>::max() : next.samples.front().time_ns;
}

ImuLogs::ImuLogs(const std::vector<std::filesystem::path>& logs, const NamedResult& before,
                 const ImuLogSettings& settings, const ImuReadings& readings, std::stop_token stop)
    : before_(before), settings_(settings), readings_(readings), stop_(std::move(stop)) {
  const std::vector<std::string> names = namesOf(before);
  for (const auto& [name, stream] : settings.streams)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw badInput("--imu " + name + "=" + stream, "the old result has no IMU of this name",
                     names.empty() ? "It has no IMUs at all" : nameAdvice(name, names));
  std::size_t streams = 0;
  for (const std::filesystem::path& log : logs) {
    Source& source = sources_.emplace_back();
    source.path = log;
    source.reader = openLog(log);
    streams += imuStreams(source);
  }
  match(streams == 1);
  for (Source& source : sources_) {
    source.reader->select(source.selected);
    source.filters.assign(source.selected.size(), StampFilter<ImuSample>(kSampleStamps));
    advance(source);
  }
  checkClocks();
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  for (const Source& source : sources_) first_ns = std::min(first_ns, source.time_ns());
  if (stop_.stop_requested()) return;
  if (first_ns == std::numeric_limits<std::int64_t>::max())
    throw badInput(logs.front().string(), "there are no IMU samples in it", "Record again, or copy it again");
  start_ns_ = first_ns;
}

// A table whose header does not identify its columns is assumed to have those of the calibration. If the calibration used
// separate streams for the two sensors and the log has both, they are joined.
std::unique_ptr<RecordingReader> ImuLogs::openLog(const std::filesystem::path& log) const {
  try {
    std::unique_ptr<RecordingReader> reader = openRecording(log);
    const auto has = [&](const std::string& name) {
      return std::ranges::any_of(reader->streams(), [&](const StreamInfo& stream) {
        return stream.type == StreamType::Imu && stream.name == name;
      });
    };
    std::vector<SeparateImu> separate = separateImus();
    std::erase_if(separate,
                  [&](const SeparateImu& imu) { return !has(imu.gyroscope) || !has(imu.accelerometer); });
    return withSeparateImus(std::move(reader), separate);
  } catch (const CalibrationError&) {
    for (const auto& [name, reading] : readings_)
      if (!reading.columns.empty()) return openRecording(log, {{log.filename().string(), reading.columns}});
    throw;
  }
}

// What is said of a stream, then its name in the calibration, then that of the IMU, then that there is no other.
std::optional<std::size_t> ImuLogs::imuOf(const Source& source, const StreamInfo& stream,
                                          bool only_one) const {
  const std::filesystem::path& log = source.path;
  const bool alone = imuStreams(source) == 1;
  for (std::size_t i = 0; i < before_.imus.size(); ++i) {
    const auto said = settings_.streams.find(before_.imus[i].name);
    if (said == settings_.streams.end()) continue;
    const bool is_log = said->second == log.string() || said->second == log.filename().string();
    // Of a log with several, the one that is called so.
    if (said->second == stream.name || (is_log && (alone || stream.name == before_.imus[i].stream))) return i;
  }
  std::vector<std::size_t> by_stream, by_name, open;
  for (std::size_t i = 0; i < before_.imus.size(); ++i) {
    const SensorDescription& imu = before_.imus[i];
    if (settings_.streams.contains(imu.name)) continue;
    open.push_back(i);
    if (!imu.stream.empty() && imu.stream == stream.name) by_stream.push_back(i);
    if (imu.name == stream.name || imu.name == log.stem().string()) by_name.push_back(i);
  }
  if (const auto found = onlyOne(by_name)) return found;
  if (const auto found = onlyOne(by_stream)) return found;
  return only_one ? onlyOne(open) : std::nullopt;
}

// As the calibration had them, and as --imu NAME='GYROSCOPE + ACCELEROMETER' names them.
std::vector<SeparateImu> ImuLogs::separateImus() const {
  std::vector<SeparateImu> imus;
  const auto add = [&](const SeparateImu& imu) {
    const auto same = [&](const SeparateImu& other) { return nameOf(other) == nameOf(imu); };
    if (std::ranges::none_of(imus, same)) imus.push_back(imu);
  };
  for (const auto& [name, reading] : readings_)
    if (!reading.accelerometer_stream.empty()) add({reading.gyroscope_stream, reading.accelerometer_stream});
  for (const auto& [name, stream] : settings_.streams)
    if (const std::size_t plus = stream.find(" + "); plus != std::string::npos)
      add({stream.substr(0, plus), stream.substr(plus + 3)});
  return imus;
}

// Its samples arrive with those of the other sensor, as another stream of the log.
bool ImuLogs::isPartOfJoined(const Source& source, const std::string& stream) const {
  const std::vector<StreamInfo>& streams = source.reader->streams();
  return std::ranges::any_of(separateImus(), [&](const SeparateImu& imu) {
    return (imu.gyroscope == stream || imu.accelerometer == stream) &&
           std::ranges::any_of(streams, [&](const StreamInfo& one) { return one.name == nameOf(imu); });
  });
}

std::size_t ImuLogs::imuStreams(const Source& source) const {
  return static_cast<std::size_t>(
      std::ranges::count_if(source.reader->streams(), [&](const StreamInfo& stream) {
        return stream.type == StreamType::Imu && !isPartOfJoined(source, stream.name);
      }));
}

void ImuLogs::match(bool only_one) {
  for (Source& source : sources_) {
    const std::vector<StreamInfo>& streams = source.reader->streams();
    for (std::size_t s = 0; s < streams.size(); ++s) {
      if (streams[s].type != StreamType::Imu || !streams[s].readable) continue;
      if (isPartOfJoined(source, streams[s].name)) continue;
      const auto imu = imuOf(source, streams[s], only_one);
      if (!imu) {
        notes_.push_back(fmt::format("{}: the stream {} is left out: the old result knows no IMU of it",
                                     source.path.filename().string(), streams[s].name));
        continue;
      }
      source.selected.push_back(s);
      source.imus.push_back(*imu);
      imus_.push_back(*imu);
    }
  }
  std::sort(imus_.begin(), imus_.end());
  imus_.erase(std::unique(imus_.begin(), imus_.end()), imus_.end());
  if (imus_.empty()) refuseUnknown();
  for (const auto& [name, stream] : settings_.streams) {
    const auto there = [&, wanted = name](std::size_t imu) { return before_.imus[imu].name == wanted; };
    if (std::none_of(imus_.begin(), imus_.end(), there))
      throw badInput("--imu " + name + "=" + stream, "there is no such stream or log",
                     "See 'evical inspect' for the streams' names");
  }
  std::erase_if(sources_, [](const Source& source) { return source.selected.empty(); });
}

void ImuLogs::refuseUnknown() const {
  std::vector<std::string> streams;
  for (const Source& source : sources_)
    for (const StreamInfo& stream : source.reader->streams())
      if (stream.type == StreamType::Imu) streams.push_back(stream.name);
  const std::string where = sources_.front().path.string();
  if (streams.empty())
    throw badInput(where, "there are no IMU samples in it", "Give a log of an IMU that was calibrated");
  const std::vector<std::string> names = namesOf(before_);
  if (names.empty())
    throw badInput(where, "the old result has no IMUs", "Give the result of a calibration with IMUs");
  throw badInput(
      where,
      fmt::format("the old result does not know the IMU of it: streams {}, IMUs of the result {}",
                  joined(streams), joined(names)),
      streams.size() < 2
          ? fmt::format("Say which it is: --imu {}={}", names.front(), streams.front())
          : fmt::format(
                "Say which it is: --imu {0}={1}; if the gyroscope and the accelerometer have separate "
                "streams: --imu {0}='GYROSCOPE + ACCELEROMETER'",
                names.front(), streams.front()));
}

const StreamInfo& ImuLogs::stream(std::size_t imu) const {
  for (const Source& source : sources_)
    for (std::size_t s = 0; s < source.imus.size(); ++s)
      if (source.imus[s] == imu) return source.reader->streams()[source.selected[s]];
  return sources_.front().reader->streams()[sources_.front().selected.front()];
}

void ImuLogs::checkClocks() const {
  constexpr double kFurthestStarts_s = 3600.0;
  const Source& first = sources_.front();
  for (const Source& source : sources_) {
    // Logs of the same IMU follow each other, however much later.
    if (first.finished || source.finished || source.imus == first.imus) continue;
    const double apart_s = secondsSince(first.time_ns(), source.time_ns());
    if (std::abs(apart_s) < kFurthestStarts_s) continue;
    throw badInput(
        source.path.string(),
        fmt::format("its clock has nothing to do with that of {}: it starts at {:.3f} s, the other "
                    "at {:.3f} s",
                    first.path.string(), secondsSince(0, source.time_ns()), secondsSince(0, first.time_ns())),
        "IMUs can be compared only on clocks that agree to seconds: give each log for itself, or "
        "record them together");
  }
}

bool ImuLogs::read(ImuLogPacket& packet) {
  const auto behind =
      std::min_element(sources_.begin(), sources_.end(),
                       [](const Source& a, const Source& b) { return a.time_ns() < b.time_ns(); });
  if (behind->finished) return false;
  checkOrder(*behind);
  std::swap(packet, behind->next);
  advance(*behind);
  return true;
}

void ImuLogs::advance(Source& source) {
  while (!source.read_out) {
    source.read_out = stop_.stop_requested() || !source.reader->read(source.raw);
    if (source.read_out) break;
    const auto found = std::find(source.selected.begin(), source.selected.end(), source.raw.stream);
    if (found == source.selected.end() || source.raw.imu_samples.empty()) continue;
    const auto place = static_cast<std::size_t>(found - source.selected.begin());
    const StreamInfo& info = source.reader->streams()[*found];
    source.next.imu = source.imus[place];
    source.next.samples.clear();
    toSamples(info, source.raw.imu_samples, source.next);
    immeasurable_ +=
        std::erase_if(source.next.samples, [](const ImuSample& sample) { return !isMeasurable(sample); });
    source.filters[place].filter(source.next.samples);
    if (!source.next.samples.empty()) return;
  }
  while (source.flushed < source.filters.size()) {
    const std::size_t place = source.flushed++;
    source.next.imu = source.imus[place];
    source.filters[place].finish(source.next.samples);
    if (!source.next.samples.empty()) return;
  }
  source.finished = true;
}

// Units as the caller says, else as the calibration read them, else as the log does; axes as the calibration read them.
void ImuLogs::toSamples(const StreamInfo& info, const std::vector<RawImuSample>& raw,
                        ImuLogPacket& packet) const {
  const auto found = readings_.find(before_.imus[packet.imu].name);
  const ImuReading reading = found == readings_.end() ? ImuReading{} : found->second;
  toSi(raw, settings_.acceleration_unit.value_or(reading.acceleration_unit.value_or(info.acceleration_unit)),
       settings_.angular_rate_unit.value_or(reading.angular_rate_unit.value_or(info.angular_rate_unit)),
       packet.samples);
  for (ImuSample& sample : packet.samples) {
    if (reading.accelerometer_stream.empty()) sample.measured_by = MeasuredBy::Both;
    sample.angular_rate_rad_s = readAs(reading.gyroscope_axes, sample.angular_rate_rad_s);
    sample.specific_force_m_s2 = readAs(reading.accelerometer_axes, sample.specific_force_m_s2);
  }
}

// Two logs of one IMU at once are of two IMUs, or the same one twice.
void ImuLogs::checkOrder(const Source& source) {
  Latest& latest = latest_[source.next.imu];
  if (latest.source != nullptr && latest.source != &source &&
      source.next.samples.front().time_ns <= latest.time_ns)
    throw badInput(source.path.string(),
                   fmt::format("has samples of the IMU '{}' at times at which another log has some, too",
                               before_.imus[source.next.imu].name),
                   "Say which log is of which IMU: --imu NAME=LOG; or give logs that follow each other");
  latest = {source.next.samples.back().time_ns, &source};
}

double ImuLogs::fractionRead() const {
  double sum = 0.0;
  for (const Source& source : sources_) sum += source.finished ? 1.0 : source.reader->fractionRead();
  return sum / static_cast<double>(sources_.size());
}

std::vector<RecordingFault> ImuLogs::faults() const {
  std::vector<RecordingFault> all;
  for (const Source& source : sources_)
    all.insert(all.end(), source.reader->faults().begin(), source.reader->faults().end());
  if (immeasurable_ > 0)
    all.push_back({"imu", FaultKind::NotFinite, 0.0,
                   fmt::format("{} IMU samples left out, whose values are no numbers, or none that a sensor "
                               "measures",
                               immeasurable_)});
  return all;
}

}  // namespace evical
