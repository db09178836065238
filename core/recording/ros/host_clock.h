// Offset of a sensor's clock to that of the host that received its data, from stamps at the arrival of
// packets. Delays vary, so the earliest packets determine it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace evical::ros {

// host_time = sensor_time + offset, at the middle of the recording; drift_ppm is its change.
struct HostClockOffset {
  double offset_s = 0.0;
  std::optional<double> drift_ppm;  // nullopt for short recordings
};

class HostClock {
 public:
  void add(std::int64_t sensor_ns, std::int64_t host_ns);

  // nullopt before the first packet.
  std::optional<HostClockOffset> offset() const;

 private:
  struct Earliest {
    std::int64_t sensor_ns = 0, offset_ns = 0;
  };
  std::map<std::int64_t, Earliest> earliest_;  // of some seconds each
};

}  // namespace evical::ros
