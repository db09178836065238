// Time range of a session, and the decision when the rest of a recording need not be read.
#pragma once

#include "core/pipeline/pass/session_recording.h"
#include "core/pipeline/session/session.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace evical {

class SessionTimeRange {
 public:
  // `sensors`: number of sensors.
  SessionTimeRange(const Session& session, std::size_t sensors, std::int64_t start_ns)
      : session_(session), start_ns_(start_ns), latest_ns_(start_ns), behind_(sensors) {}

  // True for all times if the session has no time range.
  bool holds(std::int64_t time_ns) const;

  // True after all sensors are well beyond the range: a wrong timestamp is followed by correct ones. Must be
  // called with all packets in order.
  bool isOver(const SensorPacket& packet);

  // Throws CalibrationError (BadInput) if all data are before the range. Call it at the end.
  void checkBegin() const;

 private:
  const Session& session_;
  std::int64_t start_ns_, latest_ns_;  // latest_ns_: of all data
  std::vector<bool> behind_;
};

}  // namespace evical
