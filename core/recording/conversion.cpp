#include "core/recording/conversion.h"

#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/base/number.h"
#include "core/base/time.h"
#include "core/recording/recording_writer.h"
#include "core/recording/stray_stamps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <system_error>

namespace evical {

bool isWritable(const StreamInfo& stream, const RecordingFormat& format) {
  if (stream.type == StreamType::Frames) return format.frames && stream.readable && stream.timed;
  return stream.type == StreamType::Events || (stream.type == StreamType::Imu && !format.one_camera);
}

namespace {

constexpr std::size_t kNotWritten = static_cast<std::size_t>(-1);

std::vector<std::size_t> chosenStreams(const RecordingReader& reader, const RecordingFormat& format,
                                       const ConversionRequest& request) {
  std::vector<std::size_t> chosen;
  std::vector<std::string> missing = request.streams;
  for (std::size_t i = 0; i < reader.streams().size(); ++i) {
    const StreamInfo& stream = reader.streams()[i];
    if (!isWritable(stream, format)) continue;
    const bool named =
        std::find(request.streams.begin(), request.streams.end(), stream.name) != request.streams.end();
    if (named || request.streams.empty()) chosen.push_back(i);
    std::erase(missing, stream.name);
  }
  if (!missing.empty()) {
    std::string names;
    for (const StreamInfo& stream : reader.streams())
      if (isWritable(stream, format)) names += (names.empty() ? "" : ", ") + stream.name;
    throw badInput(missing.front(),
                   fmt::format("the recording has no stream with this name that {} can contain", format.name),
                   fmt::format("It has: {}", names.empty() ? "none" : names));
  }
  if (chosen.empty())
    throw badInput(request.input.string(),
                   format.one_camera
                       ? fmt::format("the recording has no events, and {} contains nothing else", format.name)
                       : fmt::format("the recording has neither events nor IMU samples{}",
                                     format.frames ? " nor frames with times" : ""));
  return chosen;
}

// For default choices: data that users may miss.
void noteLeftOut(const RecordingReader& reader, const RecordingFormat& format,
                 const ConversionRequest& request, const RunContext& context) {
  if (!request.streams.empty()) return;
  std::string names;
  for (const StreamInfo& stream : reader.streams())
    if (((stream.type == StreamType::Frames || stream.type == StreamType::Imu) &&
         !isWritable(stream, format)) ||
        stream.type == StreamType::Points)
      names += (names.empty() ? "" : ", ") + stream.name;
  if (!names.empty())
    context.progress.log(LogLevel::Warning, fmt::format("{} cannot contain {}; omitted: {}.", format.name,
                                                        format.frames       ? "points or frames without times"
                                                        : format.one_camera ? "IMU samples, frames and points"
                                                                            : "frames and points",
                                                        names));
}

void checkPaths(const ConversionRequest& request) {
  std::error_code ignored;
  if (std::filesystem::equivalent(request.input, request.output, ignored))
    throw badInput(request.output.string(), "input and output are the same", "Choose another output");
}

// Range of the events' coordinates, if the file does not state the size.
void findSizes(const ConversionRequest& request, std::vector<StreamInfo>& streams,
               const std::vector<std::size_t>& chosen, const RunContext& context) {
  std::vector<std::size_t> unknown;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    StreamInfo& stream = streams[i];
    if (stream.type != StreamType::Events || stream.resolution_px.known()) continue;
    stream.resolution_px = request.resolution_px;
    if (!stream.resolution_px.known()) unknown.push_back(chosen[i]);
  }
  if (unknown.empty()) return;
  context.progress.stageStarted("find the sensor's size");
  const std::unique_ptr<RecordingReader> reader = openRecording(request.input);
  reader->select(unknown);
  Packet packet;
  while (reader->read(packet)) {
    context.throwIfStopped();
    context.progress.stageProgress(reader->fractionRead());
    const auto place = std::find(chosen.begin(), chosen.end(), packet.stream) - chosen.begin();
    Resolution& size_px = streams[static_cast<std::size_t>(place)].resolution_px;
    for (const Event& event : packet.events) {
      size_px.width_px = std::max<int>(size_px.width_px, event.x_px + 1);
      size_px.height_px = std::max<int>(size_px.height_px, event.y_px + 1);
    }
  }
  for (const StreamInfo& stream : streams) {
    if (stream.type != StreamType::Events) continue;
    context.progress.log(
        LogLevel::Warning,
        fmt::format("The resolution of {} is not in the file. Its events reach {} x {}; this resolution is "
                    "written.",
                    stream.name, stream.resolution_px.width_px, stream.resolution_px.height_px));
  }
}

// Formats of one camera count times from its start, so they cannot store events with wrong timestamps.
void noteStrays(const StampFilter<Event>& stamps, const RunContext& context) {
  if (stamps.strays() == 0) return;
  context.progress.log(
      LogLevel::Warning,
      fmt::format("{} left out: their timestamps differ by {:.3g} s from those of the others.",
                  counted(stamps.strays(), "event", "is", "are"),
                  std::abs(secondsSince(stamps.strayFrom_ns(), stamps.strayTime_ns()))));
}

void copyPackets(RecordingReader& reader, RecordingWriter& writer, const std::vector<std::size_t>& targets,
                 bool drop_strays, ConversionSummary& summary, const RunContext& context) {
  StampFilter<Event> stamps(kEventStamps);
  Packet packet;
  std::vector<ImuSample> samples;
  bool exposed = false;
  while (reader.read(packet)) {
    context.throwIfStopped();
    context.progress.stageProgress(reader.fractionRead());
    const std::size_t target = targets.at(packet.stream);
    if (target == kNotWritten) continue;
    const StreamInfo& info = reader.streams()[packet.stream];
    if (drop_strays) stamps.filter(packet.events);
    samples.clear();
    toSi(packet.imu_samples, info.acceleration_unit, info.angular_rate_unit, samples);
    if (!packet.events.empty()) writer.write(target, EventSpan(packet.events));
    if (!samples.empty()) writer.write(target, std::span<const ImuSample>(samples));
    for (const Frame& frame : packet.frames) {
      writer.writeFrame(target, frame);
      exposed = exposed || frame.exposure_s > 0.0;
    }
    summary.events += packet.events.size();
    summary.imu_samples += samples.size();
    summary.frames += packet.frames.size();
  }
  if (drop_strays) {
    stamps.finish(packet.events);
    if (!packet.events.empty()) writer.write(0, EventSpan(packet.events));
    summary.events += packet.events.size();
    noteStrays(stamps, context);
  }
  if (exposed)
    context.progress.log(LogLevel::Warning, "Exposure times of frames are not written: the format has none.");
  summary.faults = reader.faults();
}

// Sessions name streams.
void noteNewNames(const std::vector<StreamInfo>& streams, const std::vector<std::string>& written,
                  const RunContext& context) {
  std::string text;
  for (std::size_t i = 0; i < streams.size(); ++i)
    if (written[i] != streams[i].name)
      text += fmt::format("{}{} is called {}", text.empty() ? "" : ", ", streams[i].name, written[i]);
  if (!text.empty()) context.progress.log(LogLevel::Info, "In the new file " + text);
}

}  // namespace

ConversionSummary convertRecording(const ConversionRequest& request, const RunContext& context) {
  const RecordingFormat& format =
      request.format.empty() ? recordingFormatOf(request.output) : recordingFormat(request.format);
  const std::unique_ptr<RecordingReader> reader = openRecording(request.input);
  checkPaths(request);
  const std::vector<std::size_t> chosen = chosenStreams(*reader, format, request);
  noteLeftOut(*reader, format, request, context);
  ConversionSummary summary;
  summary.format = format.name;
  std::vector<std::size_t> targets(reader->streams().size(), kNotWritten);
  for (const std::size_t stream : chosen) {
    targets[stream] = summary.streams.size();
    StreamInfo info = reader->streams()[stream];
    info.acceleration_unit = AccelerationUnit::MetresPerSecond2;
    info.angular_rate_unit = AngularRateUnit::RadiansPerSecond;
    summary.streams.push_back(info);
  }
  findSizes(request, summary.streams, chosen, context);
  context.progress.stageStarted("convert");
  reader->select(chosen);
  std::optional<NewFolder> folder;
  if (format.isFolder()) folder.emplace(request.output);
  const std::unique_ptr<RecordingWriter> writer =
      createRecording(request.output, format.name, summary.streams);
  copyPackets(*reader, *writer, targets, format.one_camera, summary, context);
  writer->finish();
  if (const std::int64_t origin_ns = writer->origin_ns(); origin_ns != 0)
    context.progress.log(
        LogLevel::Info,
        fmt::format("{} cannot contain these times: they now count from the first event. In a "
                    "session with other sensors, set the camera's clock_offset_s: {:.6f}.",
                    format.name, 1e-9 * static_cast<double>(origin_ns)));
  if (!format.isFolder()) noteNewNames(summary.streams, writer->streamNames(), context);
  return summary;
}

}  // namespace evical
