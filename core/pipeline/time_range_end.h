// When a recording is well behind the session's time range, so that no more of it need be read.
#pragma once

#include "core/pipeline/session.h"
#include "core/pipeline/session_recording.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace evical {

class TimeRangeEnd {
 public:
  // `sensors`: that packets are numbered by.
  TimeRangeEnd(const Session& session, std::size_t sensors, std::int64_t start_ns)
      : session_(session), start_ns_(start_ns), behind_(sensors) {}

  // True once all sensors have come well behind; a stamp that is wrong is followed by right ones. All packets in turn.
  bool isReached(const SensorPacket& packet);

 private:
  const Session& session_;
  std::int64_t start_ns_;
  std::vector<bool> behind_;
};

}  // namespace evical
