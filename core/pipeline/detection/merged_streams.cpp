#include "core/pipeline/detection/merged_streams.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/base/time.h"
#include "core/data/unfit_samples.h"
#include "core/recording/plausible_times.h"
#include "core/recording/separate_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace evical {
namespace {

using Stream = MergedStreams::Stream;
using File = MergedStreams::File;

// Calls visit(items) for each kind of item in the packet.
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

// Power of 1000 by which one time since 1970 is larger than another, as in a table whose unit is wrong; 0 if
// it is none.
double unitRatio(double time_s, double other_s) {
  constexpr double kNear = 1e-3, kMin_s = 1e5;
  if (time_s <= 0.0 || other_s <= 0.0 || std::max(time_s, other_s) < kMin_s) return 0.0;
  const double thousands = std::round(std::log(time_s / other_s) / std::log(1e3));
  const double ratio = std::pow(1e3, thousands);
  return thousands != 0.0 && std::abs(time_s / other_s / ratio - 1.0) < kNear ? ratio : 0.0;
}

void takeSamples(const StreamInfo& info, const SessionImu& imu, const std::vector<RawImuSample>& raw,
                 std::vector<ImuSample>& samples) {
  toSi(raw, imu.acceleration_unit.value_or(info.acceleration_unit),
       imu.angular_rate_unit.value_or(info.angular_rate_unit), samples);
  for (ImuSample& sample : samples) {
    sample.angular_rate_rad_s *= imu.angular_rate_factor;
    sample.specific_force_m_s2 *= imu.acceleration_factor;
    // measured_by of a message is used only if the session names separate streams.
    if (imu.accelerometer_stream.empty()) sample.measured_by = MeasuredBy::Both;
    sample.angular_rate_rad_s = readAs(imu.gyroscope_axes, sample.angular_rate_rad_s);
    sample.specific_force_m_s2 = readAs(imu.accelerometer_axes, sample.specific_force_m_s2);
  }
}

// Applies the session's clock scale and offset of the sensor, after stray stamps are removed: one of them
// would be the fixed point of the scale.
void setClock(Stream& stream, SensorPacket& packet) {
  if (stream.clock_offset_s == 0.0 && stream.clock_scale == 1.0) return;
  forEachKind(packet, [&](auto& items) {
    for (auto& item : items) {
      if (!stream.first_ns) stream.first_ns = item.time_ns;
      const std::optional<std::int64_t> time_ns = stream.sessionTime_ns(item.time_ns);
      if (!time_ns)
        throw badInput(
            stream.name,
            "with clock_offset_s and clock_scale its times are implausible, centuries from those of "
            "any recording",
            "Correct these two " + howTo(HowTo::EditSession));
      item.time_ns = *time_ns;
    }
  });
}

// Converts units; moves the storage.
void toSessionUnits(File& file, Stream& stream) {
  SensorPacket& packet = file.next;
  packet.sensor = stream.sensor;
  std::swap(packet.events, file.raw.events);
  std::swap(packet.frames, file.raw.frames);
  std::swap(packet.points, file.raw.points);
  packet.imu_samples.clear();
  if (stream.imu) takeSamples(file.info(stream), *stream.imu, file.raw.imu_samples, packet.imu_samples);
}

void filterImplausible(Stream& stream, SensorPacket& packet) {
  for (const ImuSample& sample : packet.imu_samples) {
    if (!isMeasurable(sample) && stream.immeasurable++ == 0) stream.immeasurable_ns = sample.time_ns;
  }
  std::erase_if(packet.imu_samples, [](const ImuSample& sample) { return !isMeasurable(sample); });
  stream.events.filter(packet.events);
  stream.samples.filter(packet.imu_samples);
  stream.frames.filter(packet.frames);
  stream.points.filter(packet.points);
}

// Numbers in place of times, 1 s apart as for pictures without times; points of one view share theirs.
void number(Stream& stream, Packet& packet) {
  if (!stream.numbered) return;
  for (Frame& frame : packet.frames) frame.time_ns = kSecond_ns * (*stream.numbered)++;
  for (MeasuredPoint& point : packet.points) {
    if (*stream.numbered == 0 || point.time_ns != stream.recorded_ns) ++*stream.numbered;
    stream.recorded_ns = point.time_ns;
    point.time_ns = kSecond_ns * *stream.numbered;
  }
}

std::size_t bytesOf(const Packet& packet) {
  std::size_t bytes = packet.events.size() * sizeof(Event) + packet.points.size() * sizeof(MeasuredPoint);
  for (const Frame& frame : packet.frames) bytes += frame.bytes.size();
  return bytes;
}

// Flushes the samples that a stream's filter still holds at the end of the file.
bool flushNext(File& file) {
  while (file.flushed < file.streams.size()) {
    Stream& stream = file.streams[file.flushed++];
    file.next.sensor = stream.sensor;
    stream.events.finish(file.next.events);
    stream.samples.finish(file.next.imu_samples);
    stream.frames.finish(file.next.frames);
    stream.points.finish(file.next.points);
    setClock(stream, file.next);
    if (!file.next.empty()) return true;
  }
  return false;
}

}  // namespace

std::optional<std::int64_t> Stream::sessionTime_ns(std::int64_t own_ns) const {
  const std::int64_t from_ns = first_ns.value_or(own_ns);
  const double since_ns = clock_scale * static_cast<double>(own_ns - from_ns);
  if (clock_scale != 1.0 && std::abs(since_ns) < static_cast<double>(kLatestTime_ns))
    own_ns = from_ns + std::llround(since_ns);
  std::int64_t time_ns = 0;
  const bool over = __builtin_add_overflow(own_ns, nanosecondsFrom(clock_offset_s), &time_ns);
  return over || !isTime(time_ns) ? std::nullopt : std::optional(time_ns);
}

void File::add(std::size_t in_file, std::size_t sensor, const SessionCamera& camera) {
  streams.push_back({in_file, sensor, camera.name, camera.clock_offset_s, camera.clock_scale});
}

void File::add(std::size_t in_file, std::size_t sensor, const SessionImu& imu) {
  streams.push_back({in_file, sensor, imu.name, imu.clock_offset_s, imu.clock_scale, imu});
}

Stream& File::of(const Packet& packet) {
  return *std::ranges::find(streams, packet.stream, &Stream::in_file);
}

std::int64_t File::time_ns() const {
  return finished ? std::numeric_limits<std::int64_t>::max() : firstTime_ns(next);
}

std::optional<std::int64_t> MergedStreams::begin(bool camera_alone) {
  for (File& file : files_) {
    std::vector<std::size_t> selected;
    for (const Stream& stream : file.streams) selected.push_back(stream.in_file);
    file.reader->select(selected);
    if (camera_alone) judgeTimes(file);
    advance(file);
  }
  const File* const first = behind();
  return first == nullptr ? std::nullopt : std::optional(first->time_ns());
}

void MergedStreams::checkClocks(const std::function<std::string(double)>& advice) const {
  constexpr double kFurthestStarts_s = 3600.0;
  const File& first = files_.front();
  for (const File& file : files_) {
    if (first.finished || file.finished) continue;
    if (std::ranges::equal(file.streams, first.streams, {}, &Stream::sensor, &Stream::sensor)) continue;
    const double later_s = secondsSince(file.time_ns(), first.time_ns());
    if (std::abs(later_s) < kFurthestStarts_s) continue;
    const double ratio = unitRatio(secondsSince(0, file.time_ns()), secondsSince(0, first.time_ns()));
    throw badInput(
        file.path.string(),
        fmt::format("its clock is unrelated to that of {}: it starts at {:.3f} s, the other at {:.3f} s",
                    first.path.string(), secondsSince(0, file.time_ns()), secondsSince(0, first.time_ns())),
        ratio == 0.0 ? advice(later_s)
                     : fmt::format("Its times seem to be {:g} times too {}: correct their unit, in a table's "
                                   "header or where it was written",
                                   std::max(ratio, 1.0 / ratio), ratio > 1.0 ? "large" : "small"));
  }
}

const File* MergedStreams::behind() const {
  const auto found = std::ranges::min_element(files_, {}, &File::time_ns);
  return found == files_.end() || found->finished ? nullptr : &*found;
}

bool MergedStreams::read(SensorPacket& packet) {
  const File* const next = behind();
  if (next == nullptr) return false;
  File& file = files_[static_cast<std::size_t>(next - files_.data())];
  std::swap(packet, file.next);
  advance(file);
  return true;
}

bool MergedStreams::readPacket(File& file) const {
  if (file.ahead.empty()) return !stop_.stop_requested() && file.reader->read(file.raw);
  file.raw = std::move(file.ahead.front());
  file.ahead.pop_front();
  return true;
}

// From the first frames or views. Views by hand are seconds apart, so that their interval sets how far a
// stray is.
void MergedStreams::judgeTimes(File& file) const {
  constexpr std::size_t kEnough = 30, kMax_bytes = std::size_t{64} << 20;
  constexpr double kFar = 10.0;  // intervals
  Stream& stream = file.streams.front();
  const StreamType type = file.info(stream).type;
  if (!file.info(stream).timed || (type != StreamType::Frames && type != StreamType::Points)) return;
  const StopWaiting until_stop(stop_);
  SeenTimes seen;
  std::size_t bytes = 0;
  for (Packet packet; seen.count() < kEnough && bytes < kMax_bytes && file.reader->read(packet);) {
    seen.add(packet);
    bytes += bytesOf(packet);
    file.ahead.push_back(std::move(packet));
    packet = {};
  }
  if (whyImplausible(type, seen)) stream.numbered = 0;
  StampTolerance tolerance = type == StreamType::Frames ? kSampleStamps : kPointStamps;
  tolerance.ahead_ns =
      std::max(tolerance.ahead_ns, nanosecondsFrom(kFar * (stream.numbered ? 1.0 : seen.median_s())));
  if (type == StreamType::Frames) stream.frames = StampFilter<Frame>(tolerance);
  if (type == StreamType::Points) stream.points = StampFilter<MeasuredPoint>(tolerance);
}

// Reads the next packet that is not empty.
void MergedStreams::advance(File& file) {
  const StopWaiting until_stop(stop_);
  while (!file.read_out) {
    file.read_out = !readPacket(file);
    if (file.read_out) break;
    if (file.raw.empty()) continue;
    Stream& stream = file.of(file.raw);
    number(stream, file.raw);
    toSessionUnits(file, stream);
    filterImplausible(stream, file.next);
    setClock(stream, file.next);
    if (!file.next.empty()) return;
  }
  file.finished = !flushNext(file);
}

double MergedStreams::fractionRead() const {
  double sum = 0.0;
  for (const File& file : files_) sum += file.finished ? 1.0 : file.reader->fractionRead();
  return sum / static_cast<double>(files_.size());
}

void MergedStreams::addFaults(std::vector<RecordingFault>& faults) const {
  for (const File& file : files_)
    faults.insert(faults.end(), file.reader->faults().begin(), file.reader->faults().end());
}

}  // namespace evical
