// The setting that fixes a problem, as data: a command line can print it and a window offer it.
#pragma once

#include <string>

namespace evical {

struct Repair {
  // An option, "optimisation.model.gyroscope_rotation", a key of a session's IMU,
  // "imus.left_imu.acceleration_unit", or "time_range_s": accepted by setInSession
  // (core/pipeline/session/session.h).
  std::string key, value;

  bool operator==(const Repair&) const = default;
  std::string text() const { return key + "=" + value; }
};

}  // namespace evical
