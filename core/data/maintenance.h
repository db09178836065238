// What a log says of IMUs that were calibrated before: what of them has changed since, what changed on the way and when,
// and how small a change would have shown.
#pragma once

#include "core/data/assessment.h"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace evical {

// Something that changed on the way; `against` is empty where several IMUs tell that it was this one.
struct MaintenanceStep : Finding {
  double at_s = 0.0, noticed_s = 0.0;  // since the log's start, on the reference IMU's clock
};

struct MaintainedStop {
  double from_s = 0.0, to_s = 0.0;
  Eigen::Vector3d force_m_s2 = Eigen::Vector3d::Zero(),
                  rate_rad_s = Eigen::Vector3d::Zero();  // means, as measured
  double residual_m_s2 = 0.0, sigma_m_s2 = 0.0;  // of |M^-1 (f - b)| less gravity, with the numbers of now
  bool used = true;
};

// Of one IMU alone.
struct MaintainedImu {
  std::string name, stream;
  double from_s = 0.0, to_s = 0.0, rate_hz = 0.0;
  std::vector<MaintainedStop> stops;
  std::string weakest;  // what stops tell least, in words; empty without any
  double weakest_sigma = 0.0;
  double misfit = 0.0;  // RMS of the stops' residuals over their sigmas; 0: too few to tell
};

// How a quantity went over time, number by number.
struct TrackedNumber {
  std::string name;  // "x"; empty: the quantity's only one
  std::vector<double> values, sigmas;
};
struct TrackedQuantity {
  std::string name, title, unit;
  std::vector<TrackedNumber> numbers;
};
struct MaintenanceTrack {
  std::string sensor, against;
  std::vector<double> times_s;
  std::vector<TrackedQuantity> quantities;
};

// Whether it shows there: of the pair itself, or of the IMU that the pair is held against.
inline bool isIn(const MaintenanceStep& step, const MaintenanceTrack& track) {
  return step.sensor == track.sensor ? step.against == track.against
                                     : step.against.empty() && step.sensor == track.against;
}

struct Maintenance : Assessment {
  std::vector<MaintainedImu> imus;
  std::vector<MaintenanceStep> steps;
  std::vector<MaintenanceTrack> tracks;
  double duration_s = 0.0, took_s = 0.0, memory_peak_mb = 0.0;
};

}  // namespace evical
