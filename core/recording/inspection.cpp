#include "core/recording/inspection.h"

#include "core/recording/event_statistics.h"
#include "core/recording/imu_statistics.h"
#include "core/recording/separate_reader.h"

#include "core/base/number.h"
#include "core/base/time.h"
#include "core/data/imu_stamps.h"
#include "core/data/stamp_batches.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace evical {
namespace {

// `alone`: the recording has no other IMU stream.
void summarise(const std::vector<RawImuSample>& samples, const std::vector<ImuSample>& si, bool alone,
               const InspectionOptions& options, StreamSummary& summary) {
  summary.count = samples.size();
  if (samples.empty()) return;
  summary.first_ns = samples.front().time_ns;
  summary.last_ns = samples.back().time_ns;
  std::size_t rates = 0, forces = 0;  // values other than 0
  for (std::size_t i = 0; i < samples.size(); ++i) {
    summary.without_rate += lacksRate(samples[i]) ? 1 : 0;
    summary.without_force += lacksForce(samples[i]) ? 1 : 0;
    rates += samples[i].angular_rate.isZero(0.0) ? 0 : 1;
    forces += samples[i].specific_force.isZero(0.0) ? 0 : 1;
    summary.mean_acceleration += samples[i].specific_force / static_cast<double>(samples.size());
    summary.mean_angular_rate += samples[i].angular_rate / static_cast<double>(samples.size());
    if (i == 0) continue;
    const std::int64_t interval_ns = samples[i].time_ns - samples[i - 1].time_ns;
    summary.backward_steps += interval_ns < 0 ? 1 : 0;
    summary.largest_gap_ns = std::max(summary.largest_gap_ns, interval_ns);
  }
  // A driver marks the covariance as unknown by the number that means: without this sensor. Then no other
  // stream has it.
  const bool whole = alone && 2 * std::min(rates, forces) > samples.size();
  if (whole && summary.without_rate == samples.size()) summary.without_rate = 0;
  if (whole && summary.without_force == samples.size()) summary.without_force = 0;
  std::vector<std::int64_t> times_ns;
  for (const RawImuSample& sample : samples) times_ns.push_back(sample.time_ns);
  const double span_s = secondsSince(summary.first_ns, summary.last_ns);
  const double period_s =
      findStampBatches(times_ns) ? span_s / static_cast<double>(samples.size() - 1) : medianInterval_s(si);
  if (period_s > 0.0) summary.rate_hz = 1.0 / period_s;
  summary.median_acceleration = medianForceNorm(samples);
  const double steady = steadyForceNorm(si).value_or(summary.median_acceleration);
  const auto isGravityIn = [&](double unit_m_s2) {
    return isGravity(summary.median_acceleration * unit_m_s2, options) ||
           isGravity(steady * unit_m_s2, options);
  };
  const StreamInfo& info = summary.info;
  if (info.acceleration_unit != AccelerationUnit::MetresPerSecond2) {
    summary.acceleration_unit = kAccelerationUnits.at(static_cast<std::size_t>(info.acceleration_unit));
  } else {
    summary.acceleration_unit = isGravityIn(1.0)                     ? "m/s^2"
                                : isGravityIn(kStandardGravity_m_s2) ? "g"
                                                                     : "unknown";
  }
  if (info.angular_rate_unit != AngularRateUnit::RadiansPerSecond) {
    summary.angular_rate_unit = kAngularRateUnits.at(static_cast<std::size_t>(info.angular_rate_unit));
  } else {
    summary.angular_rate_unit = largestRate(samples) <= options.largest_rate_rad_s ? "rad/s" : "unknown";
  }
}

ImuStreamKind kindOf(std::uint64_t samples, std::uint64_t without_rate, std::uint64_t without_force) {
  constexpr double kFew = 0.05, kNearlyAll = 0.95;
  if (samples == 0) return ImuStreamKind::Whole;
  const double count = static_cast<double>(samples);
  const double no_rate = static_cast<double>(without_rate) / count,
               no_force = static_cast<double>(without_force) / count;
  if (no_force > kNearlyAll && no_rate < kNearlyAll) return ImuStreamKind::Gyroscope;
  if (no_rate > kNearlyAll && no_force < kNearlyAll) return ImuStreamKind::Accelerometer;
  const bool nothing = no_rate > kNearlyAll && no_force > kNearlyAll;
  const bool alternating = !nothing && no_rate > kFew && no_force > kFew && no_rate + no_force > kNearlyAll;
  return alternating ? ImuStreamKind::Alternating : ImuStreamKind::Whole;
}

// Marks the sensor of each sample in a stream of known kind.
void setMeasuredBy(const std::vector<RawImuSample>& raw, ImuStreamKind kind,
                   std::vector<ImuSample>& samples) {
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i].measured_by = kind == ImuStreamKind::Whole || lacksRate(raw[i]) == lacksForce(raw[i])
                                 ? MeasuredBy::Both
                             : lacksRate(raw[i]) ? MeasuredBy::Accelerometer
                                                 : MeasuredBy::Gyroscope;
}

// Times of frames, and of points.
class TimeStatistics {
 public:
  void add(std::int64_t time_ns) {
    if (count_++ == 0)
      first_ns_ = time_ns;
    else if (time_ns < last_ns_)
      ++backward_steps_;
    else
      largest_gap_ns_ = std::max(largest_gap_ns_, time_ns - last_ns_);
    last_ns_ = time_ns;
  }
  void add(const Frame& frame) {
    add(frame.time_ns);
    if (frame.exposure_s <= 0.0) return;
    shortest_exposure_s_ =
        longest_exposure_s_ == 0.0 ? frame.exposure_s : std::min(shortest_exposure_s_, frame.exposure_s);
    longest_exposure_s_ = std::max(longest_exposure_s_, frame.exposure_s);
  }

  void finish(StreamSummary& summary, std::vector<RecordingFault>& faults) const {
    if (summary.info.timed && backward_steps_ > 0)
      faults.push_back(
          {summary.info.name, FaultKind::BackwardTime, 0.0,
           fmt::format("Time runs backwards {}: {} are out of order.", counted(backward_steps_, "time"),
                       summary.info.type == StreamType::Frames ? "frames" : "points")});
    summary.count = count_;
    summary.first_ns = first_ns_;
    summary.last_ns = last_ns_;
    summary.backward_steps = backward_steps_;
    summary.largest_gap_ns = largest_gap_ns_;
    summary.shortest_exposure_s = shortest_exposure_s_;
    summary.longest_exposure_s = longest_exposure_s_;
    const double span_s = secondsSince(first_ns_, last_ns_);
    if (summary.info.timed && span_s > 0.0) summary.rate_hz = static_cast<double>(count_ - 1) / span_s;
  }

 private:
  std::uint64_t count_ = 0, backward_steps_ = 0;
  std::int64_t first_ns_ = 0, last_ns_ = 0, largest_gap_ns_ = 0;
  double shortest_exposure_s_ = 0.0, longest_exposure_s_ = 0.0;
};

// Frames are not read by default.
void selectAll(RecordingReader& reader) {
  std::vector<std::size_t> readable;
  bool has_frames = false;
  for (std::size_t i = 0; i < reader.streams().size(); ++i) {
    const StreamInfo& info = reader.streams()[i];
    if (!info.readable) continue;
    readable.push_back(i);
    has_frames = has_frames || info.type == StreamType::Frames;
  }
  if (has_frames) reader.select(readable);
}

}  // namespace

ImuStreamKind imuStreamKind(const StreamSummary& stream) {
  return kindOf(stream.count, stream.without_rate, stream.without_force);
}

ImuStreamKind imuStreamKind(const std::vector<ImuSample>& samples) {
  const auto withZero = [&](Eigen::Vector3d ImuSample::*value) {
    return static_cast<std::uint64_t>(std::ranges::count_if(
        samples, [value](const ImuSample& sample) { return (sample.*value).isZero(0.0); }));
  };
  return kindOf(samples.size(), withZero(&ImuSample::angular_rate_rad_s),
                withZero(&ImuSample::specific_force_m_s2));
}

Inspection inspectRecording(RecordingReader& reader, const InspectionOptions& options,
                            const RunContext& context) {
  const StopWaiting until_stop(context.stop);
  Inspection inspection;
  inspection.format = reader.format();
  std::map<std::size_t, EventStatistics> events;
  std::map<std::size_t, std::vector<RawImuSample>> imu_samples;
  std::map<std::size_t, TimeStatistics> others;  // streams with frames or points
  selectAll(reader);
  for (std::size_t i = 0; i < reader.streams().size(); ++i) {
    const StreamInfo& info = reader.streams()[i];
    if (info.type == StreamType::Events) events.try_emplace(i, info, options);
    if (info.type == StreamType::Imu) imu_samples[i];
  }
  Packet packet;
  while (reader.read(packet)) {
    context.throwIfStopped();
    context.progress.stageProgress(reader.fractionRead());
    if (!packet.events.empty()) events.at(packet.stream).add(packet.events);
    for (const Frame& frame : packet.frames) others[packet.stream].add(frame);
    for (const MeasuredPoint& point : packet.points) others[packet.stream].add(point.time_ns);
    if (packet.imu_samples.empty()) continue;
    std::vector<RawImuSample>& samples = imu_samples[packet.stream];
    samples.insert(samples.end(), packet.imu_samples.begin(), packet.imu_samples.end());
  }
  inspection.faults = reader.faults();
  const auto hasWrongTimes = [faults = inspection.faults](const StreamInfo& info) {
    return std::ranges::any_of(faults, [&](const RecordingFault& fault) {
      return fault.kind == FaultKind::Unit && fault.stream == info.name;
    });
  };
  for (std::size_t i = 0; i < reader.streams().size(); ++i) {
    StreamSummary& summary = inspection.streams.emplace_back();
    summary.info = reader.streams()[i];
    if (summary.info.type == StreamType::Frames && hasWrongTimes(summary.info)) summary.info.timed = false;
    summary.count = summary.info.messages;
    if (const auto found = others.find(i); found != others.end())
      found->second.finish(summary, inspection.faults);
    if (summary.info.type == StreamType::Events) events.at(i).finish(summary, inspection.faults);
    if (summary.info.type != StreamType::Imu) continue;
    std::vector<ImuSample> samples;
    toSi(imu_samples[i], summary.info.acceleration_unit, summary.info.angular_rate_unit, samples);
    std::vector<ImuSample> timed = samples;
    if (std::ranges::is_sorted(timed, {}, &ImuSample::time_ns)) reconstructStamps(timed);
    summarise(imu_samples[i], timed, imu_samples.size() == 1, options, summary);
    setMeasuredBy(imu_samples[i], imuStreamKind(summary), samples);
    const std::vector<RecordingFault> found = checkImu(summary.info.name, samples, options);
    inspection.faults.insert(inspection.faults.end(), found.begin(), found.end());
  }
  if (inspection.streams.empty())
    inspection.faults.push_back(
        {"", FaultKind::Empty, 0.0, "The recording has no streams: nothing was recorded."});
  return inspection;
}

namespace {

using Json = nlohmann::ordered_json;

Json numbers(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

Json sizeJson(const Resolution& size_px) {
  return size_px.known() ? Json{size_px.width_px, size_px.height_px} : Json();
}

void addFrames(const StreamSummary& stream, Json& json) {
  const StreamInfo& info = stream.info;
  json.update(
      {{"resolution_px", sizeJson(info.resolution_px)}, {"readable", info.readable}, {"timed", info.timed}});
  if (stream.longest_exposure_s > 0.0)
    json["exposure_s"] = {stream.shortest_exposure_s, stream.longest_exposure_s};
}

Json streamJson(const StreamSummary& stream, bool with_checksums) {
  const StreamInfo& info = stream.info;
  Json json = {{"name", info.name},
               {"type", streamTypeName(info.type)},
               {"message", info.message},
               {"count", stream.count}};
  const bool frames = info.type == StreamType::Frames;
  if (frames) addFrames(stream, json);
  const bool timeless = frames && (!info.timed || !info.readable);
  if ((info.type != StreamType::Events && info.type != StreamType::Imu && !frames) || timeless) return json;
  if (info.type == StreamType::Events) json.update({{"on", stream.on}, {"off", stream.off}});
  json.update({{"first_ns", stream.first_ns},
               {"last_ns", stream.last_ns},
               {"rate_hz", stream.rate_hz},
               {"backward_steps", stream.backward_steps},
               {"largest_gap_ns", stream.largest_gap_ns}});
  if (info.type == StreamType::Imu) {
    json.update({{"acceleration_unit", stream.acceleration_unit},
                 {"angular_rate_unit", stream.angular_rate_unit},
                 {"median_acceleration", stream.median_acceleration},
                 {"mean_acceleration", numbers(stream.mean_acceleration)},
                 {"mean_angular_rate", numbers(stream.mean_angular_rate)}});
    return json;
  }
  if (frames) return json;
  json["resolution_px"] = sizeJson(info.resolution_px);
  if (info.host_clock_offset_s) json["host_clock_offset_s"] = *info.host_clock_offset_s;
  json["seen_px"] = {stream.seen_px.width_px, stream.seen_px.height_px};
  if (stream.shortest_interval_s > 0.0) json["shortest_interval_s"] = stream.shortest_interval_s;
  if (!stream.note.empty()) json["note"] = stream.note;
  if (with_checksums) {
    // In the file's own time unit.
    const bool in_us = info.time_unit_ns == 1000;
    json.update({{"sum_x", stream.sum_x},
                 {"sum_y", stream.sum_y},
                 {in_us ? "sum_t_us_mod_2_64" : "sum_t_ns_mod_2_64", stream.sum_t}});
  }
  return json;
}

}  // namespace

std::string inspectionJson(const Inspection& inspection, bool with_checksums) {
  Json json = {{"evical_inspect", 1},
               {"format", inspection.format},
               {"faults", Json::array()},
               {"streams", Json::array()}};
  for (const RecordingFault& fault : inspection.faults) {
    json["faults"].push_back(
        {{"stream", fault.stream}, {"kind", nameOf(fault.kind)}, {"at_s", fault.at_s}, {"text", fault.text}});
  }
  for (const StreamSummary& stream : inspection.streams)
    json["streams"].push_back(streamJson(stream, with_checksums));
  // Names come from the file and may contain any bytes.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace evical
