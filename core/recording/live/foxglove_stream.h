// ROS topics without ROS: Foxglove's WebSocket protocol, as foxglove_bridge sends it.
// Source: the specification in github.com/foxglove/ws-protocol, and foxglove-sdk.
#pragma once

#include "core/recording/live/spool.h"

#include <stop_token>
#include <string>
#include <string_view>

namespace evical {

// Current servers accept only the first, older ones only the second; the messages are the same.
inline constexpr std::string_view kFoxgloveSdk = "foxglove.sdk.v1",
                                  kFoxgloveWebSocket = "foxglove.websocket.v1";

// Stores events, IMU samples and images of "ws://host:port" as an MCAP file until the server or a stop ends
// it. A connection that breaks is opened again. Throws CalibrationError.
void storeFoxgloveStream(const std::string& address, Spool& spool, const std::stop_token& stop);

}  // namespace evical
