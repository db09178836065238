// Server of Foxglove's WebSocket protocol, as foxglove_bridge: all streams at one port (foxglove_stream.h).
#pragma once

#include "core/recording/live/live_player.h"
#include "core/recording/live/socket.h"

#include <memory>
#include <stop_token>
#include <vector>

namespace evical {

// Throws CalibrationError (BadInput) if the port cannot be used, or for events without a resolution.
std::unique_ptr<LiveServer> createFoxgloveServer(const LiveAddress& address,
                                                 const std::vector<StreamInfo>& streams,
                                                 const std::stop_token& stop);

}  // namespace evical
