#include "core/pipeline/maintain/imu_logs.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/base/nearest_name.h"
#include "core/base/number.h"
#include "core/base/time.h"
#include "core/data/imu_stamps.h"
#include "core/numerics/robust.h"
#include "core/pipeline/detection/session_recording.h"
#include "core/recording/separate_imu.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace evical {
namespace {

std::vector<std::string> namesOf(const NamedResult& before) {
  std::vector<std::string> names;
  for (const SensorDescription& imu : before.imus) names.push_back(imu.name);
  return names;
}

// Name of the stream after its sensors are joined.
std::string joinedStreamOf(const SensorDescription& imu) {
  return imu.accelerometer_stream.empty() ? imu.stream
                                          : nameOf(SeparateImu{imu.stream, imu.accelerometer_stream});
}

// Number of the first samples that are earlier than all others, without the last seconds.
std::size_t cutOf(const std::vector<ImuSample>& samples) {
  constexpr std::int64_t kWait_ns =
      5 * kSecond_ns;  // longer than most disorder and stretches of second clocks
  std::vector<std::int64_t> latest_ns;
  for (const ImuSample& sample : samples)
    latest_ns.push_back(latest_ns.empty() ? sample.time_ns : std::max(latest_ns.back(), sample.time_ns));
  std::int64_t rest_ns = latest_ns.back();
  for (std::size_t k = samples.size(); k-- > 1;) {
    rest_ns = std::min(rest_ns, samples[k].time_ns);
    if (latest_ns[k - 1] < std::min(rest_ns, latest_ns.back() - kWait_ns)) return k;
  }
  return 0;
}

std::optional<std::size_t> onlyOne(const std::vector<std::size_t>& found) {
  return found.size() == 1 ? std::optional(found.front()) : std::nullopt;
}

}  // namespace

ImuLogs::ImuLogs(const std::vector<std::filesystem::path>& logs, const NamedResult& before,
                 const ImuLogSettings& settings, const ImuReadings& readings, std::stop_token stop)
    : before_(before), settings_(settings), readings_(readings), streams_(stop) {
  const std::vector<std::string> names = namesOf(before);
  for (const auto& [name, stream] : settings.streams)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw badInput(howTo(HowTo::NameLogOfImu, {name, stream}), "the old result has no IMU of this name",
                     names.empty() ? "It has no IMUs" : nameAdvice(name, names));
  std::size_t streams = 0;
  for (const LogFiles& files : paired(logs))
    streams += imuStreams(streams_.files().emplace_back(Log{files.log, openLog(files)}));
  match(streams == 1);
  const std::optional<std::int64_t> first_ns = streams_.begin();
  streams_.checkClocks([](double) {
    return "Process each log separately, or record the IMUs together: clocks must agree to within seconds";
  });
  if (stop.stop_requested()) return;
  if (!first_ns)
    throw badInput(logs.front().string(), "has no IMU samples", "Record again, or copy the file again");
  start_ns_ = *first_ns;
}

// Each table of a gyroscope with that of its accelerometer, in the same folder if possible. Their names are
// those of the calibration's files, or of --imu.
std::vector<ImuLogs::LogFiles> ImuLogs::paired(const std::vector<std::filesystem::path>& logs) const {
  std::vector<LogFiles> all;
  for (const std::filesystem::path& log : logs) all.push_back({log, {}});
  for (const SeparateImu& imu : separateImus()) {
    std::vector<std::filesystem::path> taken;
    for (LogFiles& files : all) {
      if (files.log.filename() != imu.gyroscope || !files.accelerometer.empty()) continue;
      for (const LogFiles& other : all) {
        const bool fits = other.log != files.log && std::ranges::find(taken, other.log) == taken.end() &&
                          accelerometerTable(files.log, other.log) == imu.accelerometer;
        const bool closer = other.log.parent_path() == files.log.parent_path();
        if (fits && (files.accelerometer.empty() || closer)) files.accelerometer = other.log;
      }
      taken.push_back(files.accelerometer);
    }
    std::erase_if(all, [&](const LogFiles& files) {
      return !files.log.empty() && std::ranges::find(taken, files.log) != taken.end();
    });
  }
  return all;
}

std::unique_ptr<RecordingReader> ImuLogs::openPair(const LogFiles& files) const {
  const SeparateImu tables{files.log.filename().string(), accelerometerTable(files.log, files.accelerometer)};
  try {
    return withSeparateImus(openBoth(files.log, files.accelerometer), {tables});
  } catch (const CalibrationError&) {
    for (const auto& [name, reading] : readings_)
      if (reading.stream == tables.gyroscope && !reading.columns.empty())
        return withSeparateImus(openBoth(files.log, files.accelerometer,
                                         {{tables.gyroscope, reading.columns},
                                          {tables.accelerometer, reading.accelerometer_columns.empty()
                                                                     ? reading.columns
                                                                     : reading.accelerometer_columns}}),
                                {tables});
    throw;
  }
}

// A table whose header does not identify its columns is assumed to have those of the calibration. If the
// calibration used separate streams for the two sensors and the log has both, they are joined.
std::unique_ptr<RecordingReader> ImuLogs::openLog(const LogFiles& files) const {
  if (!files.accelerometer.empty()) return openPair(files);
  const std::filesystem::path& log = files.log;
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

// Matches a stream to an IMU: by the settings, by its name in the calibration, by the IMU's name, or as the
// only one. The name of a log with several streams identifies none of them.
std::optional<ImuLogs::Match> ImuLogs::imuOf(const Log& file, const StreamInfo& stream, bool only_one) const {
  const std::filesystem::path& log = file.path;
  const bool alone = imuStreams(file) == 1;
  for (std::size_t i = 0; i < before_.imus.size(); ++i) {
    const auto said = settings_.streams.find(before_.imus[i].name);
    if (said == settings_.streams.end()) continue;
    const bool is_log = said->second == log.string() || said->second == log.filename().string();
    // In a log with several streams, the one with this name.
    if (said->second == stream.name || (is_log && (alone || stream.name == joinedStreamOf(before_.imus[i]))))
      return Match{i, MatchedBy::Setting};
  }
  std::vector<std::size_t> by_stream, by_name, open;
  for (std::size_t i = 0; i < before_.imus.size(); ++i) {
    const SensorDescription& imu = before_.imus[i];
    if (settings_.streams.contains(imu.name)) continue;
    open.push_back(i);
    if (!imu.stream.empty() && joinedStreamOf(imu) == stream.name) by_stream.push_back(i);
    if (imu.name == stream.name || (alone && imu.name == log.stem().string())) by_name.push_back(i);
  }
  if (const auto found = onlyOne(by_stream)) return Match{*found, MatchedBy::Stream};
  if (const auto found = onlyOne(by_name)) return Match{*found, MatchedBy::Name};
  if (const auto found = onlyOne(open); found && only_one) return Match{*found, MatchedBy::Default};
  return std::nullopt;
}

// From the calibration, and from --imu NAME='GYROSCOPE + ACCELEROMETER'.
std::vector<SeparateImu> ImuLogs::separateImus() const {
  std::vector<SeparateImu> imus;
  const auto add = [&](const SeparateImu& imu) {
    const auto same = [&](const SeparateImu& other) { return nameOf(other) == nameOf(imu); };
    if (std::ranges::none_of(imus, same)) imus.push_back(imu);
  };
  for (const auto& [name, reading] : readings_)
    if (!reading.accelerometer_stream.empty()) add({reading.stream, reading.accelerometer_stream});
  for (const auto& [name, stream] : settings_.streams)
    if (const std::size_t plus = stream.find(" + "); plus != std::string::npos)
      add({stream.substr(0, plus), stream.substr(plus + 3)});
  return imus;
}

// True if its samples are part of a joined stream of the log.
bool ImuLogs::isPartOfJoined(const Log& log, const std::string& stream) const {
  const std::vector<StreamInfo>& streams = log.reader->streams();
  return std::ranges::any_of(separateImus(), [&](const SeparateImu& imu) {
    return (imu.gyroscope == stream || imu.accelerometer == stream) &&
           std::ranges::any_of(streams, [&](const StreamInfo& one) { return one.name == nameOf(imu); });
  });
}

bool ImuLogs::isCandidate(const Log& log, const StreamInfo& stream) const {
  return stream.type == StreamType::Imu && stream.readable && !isPartOfJoined(log, stream.name);
}

std::size_t ImuLogs::imuStreams(const Log& log) const {
  return static_cast<std::size_t>(std::ranges::count_if(log.reader->streams(), [&](const StreamInfo& stream) {
    return stream.type == StreamType::Imu && !isPartOfJoined(log, stream.name);
  }));
}

// IMUs of one log's streams. Streams that match an IMU less well than another stream of the log are left out.
std::vector<std::optional<ImuLogs::Match>> ImuLogs::matchesOf(const Log& log, bool only_one) const {
  const std::vector<StreamInfo>& streams = log.reader->streams();
  std::vector<std::optional<Match>> matches(streams.size());
  std::map<std::size_t, std::size_t> best;  // stream by IMU
  for (std::size_t s = 0; s < streams.size(); ++s) {
    if (!isCandidate(log, streams[s])) continue;
    matches[s] = imuOf(log, streams[s], only_one);
    if (!matches[s]) continue;
    const auto [other, is_first] = best.try_emplace(matches[s]->imu, s);
    if (is_first) continue;
    std::optional<Match>& known = matches[other->second];
    if (known->by == matches[s]->by)
      throw badInput(log.path.string(),
                     fmt::format("its streams {} and {} both match the IMU '{}'", streams[other->second].name,
                                 streams[s].name, before_.imus[known->imu].name),
                     "Specify the stream: " +
                         howTo(HowTo::NameLogOfImu, {before_.imus[known->imu].name, streams[s].name}));
    (known->by < matches[s]->by ? matches[s] : known).reset();
    if (matches[s]) other->second = s;
  }
  return matches;
}

void ImuLogs::match(bool only_one) {
  for (Log& log : streams_.files()) {
    const std::vector<StreamInfo>& streams = log.reader->streams();
    const std::vector<std::optional<Match>> matches = matchesOf(log, only_one);
    for (std::size_t s = 0; s < streams.size(); ++s) {
      if (!isCandidate(log, streams[s])) continue;
      if (!matches[s]) {
        notes_.push_back(
            fmt::format("{}: the stream {} is ignored: it matches no IMU of the old result, or another "
                        "stream matches better",
                        log.path.filename().string(), streams[s].name));
        continue;
      }
      log.add(s, matches[s]->imu, readingOf(matches[s]->imu));
      imus_.push_back(matches[s]->imu);
    }
  }
  std::sort(imus_.begin(), imus_.end());
  imus_.erase(std::unique(imus_.begin(), imus_.end()), imus_.end());
  if (imus_.empty()) refuseUnknown();
  for (const auto& [name, stream] : settings_.streams) {
    const auto there = [&, wanted = name](std::size_t imu) { return before_.imus[imu].name == wanted; };
    if (std::none_of(imus_.begin(), imus_.end(), there))
      throw badInput(howTo(HowTo::NameLogOfImu, {name, stream}), "there is no such stream or log",
                     "Check the streams' names " + howTo(HowTo::Inspect));
  }
  std::erase_if(streams_.files(), [](const Log& log) { return log.streams.empty(); });
}

void ImuLogs::refuseUnknown() const {
  std::vector<std::string> streams;
  for (const Log& log : streams_.files())
    for (const StreamInfo& stream : log.reader->streams())
      if (stream.type == StreamType::Imu) streams.push_back(stream.name);
  const std::string where = streams_.files().front().path.string();
  if (streams.empty()) throw badInput(where, "has no IMU samples", "Give a log of a calibrated IMU");
  const std::vector<std::string> names = namesOf(before_);
  if (names.empty())
    throw badInput(where, "the old result has no IMUs", "Give the result of a calibration with IMUs");
  const std::string which =
      "Specify the IMU: " + howTo(HowTo::NameLogOfImu, {names.front(), streams.front()});
  throw badInput(where,
                 fmt::format("no stream matches an IMU of the old result: streams {}, IMUs of the result {}",
                             joined(streams), joined(names)),
                 streams.size() < 2
                     ? which
                     : which + "; if the gyroscope and the accelerometer have separate streams: " +
                           howTo(HowTo::NameLogOfImu, {names.front(), "'GYROSCOPE + ACCELEROMETER'"}));
}

const StreamInfo& ImuLogs::stream(std::size_t imu) const {
  for (const Log& log : streams_.files())
    for (const MergedStreams::Stream& stream : log.streams)
      if (stream.sensor == imu) return log.info(stream);
  return streams_.files().front().info(streams_.files().front().streams.front());
}

// Units from the caller, else from the calibration, else from the log; axes from the calibration. A log has
// its own clock.
SessionImu ImuLogs::readingOf(std::size_t imu) const {
  const auto found = readings_.find(before_.imus[imu].name);
  SessionImu reading = found == readings_.end() ? SessionImu{} : found->second;
  if (settings_.acceleration_unit) {
    reading.acceleration_unit = settings_.acceleration_unit;
    reading.acceleration_factor = 1.0;
  }
  if (settings_.angular_rate_unit) {
    reading.angular_rate_unit = settings_.angular_rate_unit;
    reading.angular_rate_factor = 1.0;
  }
  reading.clock_offset_s = 0.0;
  reading.clock_scale = 1.0;
  return reading;
}

bool ImuLogs::read(SensorPacket& packet) {
  while (packets_.empty() && !ended_) readBlock();
  if (packets_.empty()) return false;
  packet = std::move(packets_.front());
  packets_.pop_front();
  return true;
}

void ImuLogs::readBlock() {
  constexpr std::int64_t kBlock_ns = 60 * kSecond_ns;
  if (const Log* const log = streams_.behind()) checkOrder(*log);
  SensorPacket packet;
  ended_ = !streams_.read(packet);
  if (ended_) return release(true);
  if (packet.imu_samples.empty()) return;
  Block& block = blocks_.try_emplace(packet.sensor, Block{packet.imu_samples.front().time_ns}).first->second;
  block.waiting.insert(block.waiting.end(), packet.imu_samples.begin(), packet.imu_samples.end());
  const std::int64_t span_ns = block.waiting.back().time_ns - block.waiting.front().time_ns;
  if (block.waiting.size() >= block.next_size && (span_ns > kBlock_ns || span_ns < 0)) release(false);
}

// Hands out samples of all IMUs in order of time. Without `all`, the last seconds wait.
void ImuLogs::release(bool all) {
  for (auto& [imu, block] : blocks_) putInOrder(imu, block, all);
  constexpr std::int64_t kPacket_ns = kSecond_ns / 10;
  for (;;) {
    Block* first = nullptr;
    std::size_t imu = 0;
    for (auto& [index, block] : blocks_) {
      if (block.taken == block.ready.size()) continue;
      if (first != nullptr && block.ready[block.taken].time_ns >= first->ready[first->taken].time_ns)
        continue;
      first = &block;
      imu = index;
    }
    if (first == nullptr) return;
    SensorPacket& packet = packets_.emplace_back();
    packet.sensor = imu;
    const std::int64_t end_ns = first->ready[first->taken].time_ns + kPacket_ns;
    while (first->taken < first->ready.size() && first->ready[first->taken].time_ns < end_ns)
      packet.imu_samples.push_back(first->ready[first->taken++]);
  }
}

void ImuLogs::putInOrder(std::size_t imu, Block& block, bool all) {
  constexpr std::size_t kMax = 500'000;
  if (block.waiting.empty()) return;
  const std::size_t count = all || block.waiting.size() > kMax ? block.waiting.size() : cutOf(block.waiting);
  const auto end = block.waiting.begin() + static_cast<std::ptrdiff_t>(count);
  block.ready.assign(block.waiting.begin(), end);
  block.taken = 0;
  block.waiting.erase(block.waiting.begin(), end);
  block.next_size = block.waiting.size() + block.waiting.size() / 2;
  std::vector<RecordingFault> found;
  if (count > 0)
    block.stamp_step_s = std::max(block.stamp_step_s,
                                  evical::putInOrder(stream(imu).name, block.first_ns, block.ready, found));
  for (RecordingFault& fault : found) {
    const auto alike = [&](const RecordingFault& other) {
      return other.stream == fault.stream && other.kind == fault.kind;
    };
    const auto same = [&](const RecordingFault& other) { return alike(other) && other.text == fault.text; };
    if (std::ranges::count_if(stamp_faults_, alike) < kMostAlikeFaults &&
        std::ranges::none_of(stamp_faults_, same))
      stamp_faults_.push_back(std::move(fault));
  }
}

// Two simultaneous logs of one IMU are of two IMUs, or duplicates.
void ImuLogs::checkOrder(const Log& log) {
  const std::vector<ImuSample>& samples = log.next.imu_samples;
  Latest& latest = latest_[log.next.sensor];
  if (latest.log != nullptr && latest.log != &log && samples.front().time_ns <= latest.time_ns)
    throw badInput(
        log.path.string(),
        fmt::format("overlaps in time with another log of the IMU '{}'", before_.imus[log.next.sensor].name),
        "Specify the IMU of each log: " + howTo(HowTo::NameLogOfImu, {"NAME", "LOG"}) +
            "; or give logs that follow each other");
  latest = {samples.back().time_ns, &log};
}

double ImuLogs::stampStep_s(std::size_t imu) const {
  const auto found = blocks_.find(imu);
  return found == blocks_.end() ? 0.0 : found->second.stamp_step_s;
}

std::vector<RecordingFault> ImuLogs::faults() const {
  std::vector<RecordingFault> all;
  streams_.addFaults(all);
  all.insert(all.end(), stamp_faults_.begin(), stamp_faults_.end());
  std::uint64_t immeasurable = 0;
  for (const Log& log : streams_.files())
    for (const MergedStreams::Stream& stream : log.streams) immeasurable += stream.immeasurable;
  if (immeasurable > 0)
    all.push_back(
        {"imu", FaultKind::NotFinite, 0.0,
         counted(immeasurable, "IMU sample") + " excluded, whose values are not finite or not plausible"});
  return all;
}

namespace {

constexpr std::size_t kFewestUnitWindows = 20;  // windows

}  // namespace

void checkUnits(const ImuMeans& imu) {
  if (imu.windows.size() < kFewestUnitWindows) return;
  std::vector<double> norms;
  for (const MeansWindow& window : imu.windows) norms.push_back(window.force_m_s2.norm());
  const double norm = medianOf(std::move(norms));
  if (norm > 0.3 && norm < 3.0)
    throw badInput(imu.name, fmt::format("its mean specific force is {:.2f} m/s^2: the log is in g", norm),
                   "Give " + howTo(HowTo::SetAccelerationUnit, {"g"}));
  if (norm > 30.0)
    throw badInput(
        imu.name,
        fmt::format("its mean specific force is {:.0f} m/s^2: the log is already in m/s^2, or in milli-g",
                    norm),
        "Give " + howTo(HowTo::SetAccelerationUnit, {"m/s^2"}) + ", or convert the log");
  const double scale = rateScale(imu.windows);
  if (scale > 0.01 && scale < 0.03)
    throw badInput(
        imu.name,
        fmt::format(
            "gravity rotates {:.0f} times more slowly than the gyroscope measures: the rates are in deg/s",
            1.0 / scale),
        "Give " + howTo(HowTo::SetAngularRateUnit, {"deg/s"}));
  if (scale > 30.0 && scale < 100.0)
    throw badInput(
        imu.name,
        fmt::format("gravity rotates {:.0f} times faster than the gyroscope measures: the rates are in rad/s",
                    scale),
        "Give " + howTo(HowTo::SetAngularRateUnit, {"rad/s"}));
}

void checkDirection(const ImuMeans& own, const ImuMeans& reference,
                    const Eigen::Quaterniond& reference_from_own, double later_s) {
  std::vector<double> cosines;
  auto other = reference.windows.begin();
  for (const MeansWindow& window : own.windows) {
    const double time_s = window.time_s + later_s;
    other = std::find_if(other, reference.windows.end(), [&](const MeansWindow& each) {
      return each.time_s + 0.5 * WindowMeans::kLength_s > time_s;
    });
    if (other == reference.windows.end()) break;
    if (other->time_s > time_s + 0.5 * WindowMeans::kLength_s) continue;
    const Eigen::Vector3d turned = reference_from_own * window.force_m_s2;
    cosines.push_back(turned.dot(other->force_m_s2) /
                      std::max(turned.norm() * other->force_m_s2.norm(), 1e-9));
  }
  constexpr double kAgainst = -0.5;
  if (cosines.size() < kFewestUnitWindows || medianOf(std::move(cosines)) > kAgainst) return;
  throw badInput(own.name,
                 fmt::format("its specific force is opposite to that of {}: one of the two logs has "
                             "gravity instead of specific force (unit -g), or an IMU was mounted upside down",
                             reference.name),
                 "Convert the wrong log (" + howTo(HowTo::SetAccelerationUnit, {"-g"}) +
                     " applies to all logs), or calibrate again");
}

}  // namespace evical
