#include "core/recording/live/live_player.h"

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/number.h"
#include "core/base/time.h"
#include "core/recording/live/dv_server.h"
#include "core/recording/live/foxglove_server.h"
#include "core/recording/recording_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>

namespace evical {
namespace {

using Clock = std::chrono::steady_clock;

std::int64_t endOf_ns(const Packet& packet) {
  return packet.events.empty() ? packet.imu_samples.back().time_ns : packet.events.back().time_ns;
}

// IMU samples in the units of iniVation's streams.
void toGravityAndDegrees(const StreamInfo& info, std::vector<RawImuSample>& samples) {
  std::vector<ImuSample> si;
  toSi(samples, info.acceleration_unit, info.angular_rate_unit, si);
  for (std::size_t i = 0; i < si.size(); ++i)
    samples[i] = fromSi(si[i], AccelerationUnit::Gravity, AngularRateUnit::DegreesPerSecond);
}

}  // namespace

PlaySummary playRecording(const PlayRequest& request, const RunContext& context) {
  const LiveAddress address = liveAddress(request.address);
  const std::unique_ptr<RecordingReader> reader = openRecording(request.recording);
  std::vector<std::size_t> chosen, target(reader->streams().size());
  std::vector<StreamInfo> streams;
  for (std::size_t i = 0; i < reader->streams().size(); ++i) {
    const StreamInfo& info = reader->streams()[i];
    if (!info.readable || (info.type != StreamType::Events && info.type != StreamType::Imu)) continue;
    target[i] = streams.size();
    chosen.push_back(i);
    streams.push_back(info);
  }
  if (streams.empty())
    throw badInput(request.recording.string(), "it has neither events nor IMU samples",
                   "Choose another recording");
  reader->select(chosen);
  const std::unique_ptr<LiveServer> server = address.scheme == "ws"
                                                 ? createFoxgloveServer(address, streams, context.stop)
                                                 : createDvServer(address, streams, context.stop);
  context.progress.log(LogLevel::Info, "Waiting for clients of " + joined(server->addresses()) + ".");
  context.progress.stageStarted("wait for clients");
  if (!server->awaitClients()) throw Cancelled{};
  context.progress.stageStarted("play");
  PlaySummary summary;
  Packet packet;
  std::optional<std::int64_t> first_ns;
  const Clock::time_point begin = Clock::now();
  while (!context.stop.stop_requested() && reader->read(packet)) {
    toGravityAndDegrees(reader->streams()[packet.stream], packet.imu_samples);
    const std::int64_t end_ns = endOf_ns(packet);
    if (!first_ns) first_ns = end_ns;
    const std::chrono::duration<double> due(secondsSince(*first_ns, end_ns) / request.speed);
    const std::chrono::duration<double> late = Clock::now() - begin - due;
    if (late.count() < 0.0) std::this_thread::sleep_for(-late);
    summary.largest_delay_s = std::max(summary.largest_delay_s, late.count());
    server->send(target[packet.stream], packet, static_cast<std::uint64_t>(end_ns));
    summary.events += packet.events.size();
    summary.imu_samples += packet.imu_samples.size();
    context.progress.stageProgress(reader->fractionRead());
  }
  return summary;
}

}  // namespace evical
