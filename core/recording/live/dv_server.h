// Server of iniVation's streams: one port per stream (dv_stream.h).
#pragma once

#include "core/recording/live/live_player.h"
#include "core/recording/live/socket.h"

#include <memory>
#include <stop_token>
#include <vector>

namespace evical {

// Throws CalibrationError (BadInput) if a port cannot be used.
std::unique_ptr<LiveServer> createDvServer(const LiveAddress& address, const std::vector<StreamInfo>& streams,
                                           const std::stop_token& stop);

}  // namespace evical
