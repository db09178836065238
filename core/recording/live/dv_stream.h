// iniVation's network streams, as dv-processing's NetworkWriter and DV send them: the header and the packets
// of an AEDAT4 file, without its first line. Older servers send no header.
// Source: dv-processing (io/network_writer.hpp, network_reader.hpp).
#pragma once

#include "core/recording/live/spool.h"

#include <stop_token>
#include <string>

namespace evical {

// Stores the stream of "tcp://host:port" or "unix:///path" as an AEDAT4 file until the server or a stop ends
// it. A connection that breaks is opened again. Throws CalibrationError.
void storeDvStream(const std::string& address, Spool& spool, const std::stop_token& stop);

}  // namespace evical
