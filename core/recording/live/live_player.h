// Plays a recording to programs on the network, as a camera's software sends its streams.
#pragma once

#include "core/base/progress.h"
#include "core/data/recording.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace evical {

// Sends streams to the clients of an address. It waits for slow clients, and drops nothing.
class LiveServer {
 public:
  virtual ~LiveServer() = default;
  virtual std::vector<std::string> addresses() const = 0;
  // Waits until clients use all streams. False after a stop.
  virtual bool awaitClients() = 0;
  virtual void send(std::size_t stream, const Packet& packet, std::uint64_t time_ns) = 0;
};

struct PlayRequest {
  std::filesystem::path recording;
  // "tcp://host:port": iniVation's streams, one port for each, in their order. "ws://host:port": ROS messages
  // in Foxglove's protocol.
  std::string address;
  double speed = 1.0;  // of the recording's times
};

struct PlaySummary {
  std::uint64_t events = 0, imu_samples = 0;
  double largest_delay_s = 0.0;  // behind the recording's times
};

// Waits for clients of all streams, then plays. Throws CalibrationError (BadInput, also if the address is in
// use), and Cancelled.
PlaySummary playRecording(const PlayRequest& request, const RunContext& context);

}  // namespace evical
