// The part of a recording that a session asks for, and when a recording is so far behind it that no more need be read.
#pragma once

#include "core/pipeline/pass/session_recording.h"
#include "core/pipeline/session/session.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace evical {

class SessionTimeRange {
 public:
  // `sensors`: that packets are numbered by.
  SessionTimeRange(const Session& session, std::size_t sensors, std::int64_t start_ns)
      : session_(session), start_ns_(start_ns), behind_(sensors) {}

  // Everything where the session asks for no part.
  bool holds(std::int64_t time_ns) const;

  // True once all sensors have come well behind; a stamp that is wrong is followed by right ones. All packets in turn.
  bool isOver(const SensorPacket& packet);

 private:
  const Session& session_;
  std::int64_t start_ns_;
  std::vector<bool> behind_;
};

}  // namespace evical
