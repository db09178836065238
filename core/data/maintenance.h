// Result of the maintenance of calibrated IMUs with a log: changes since the calibration, changes during the
// log with their times, and the smallest detectable change.
#pragma once

#include "core/data/assessment.h"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace evical {

// A change during the log; `against` is empty if several IMUs identify the one that changed.
struct MaintenanceStep : Finding {
  double at_s = 0.0, noticed_s = 0.0;  // since the log's start, on the reference IMU's clock
};

struct MaintainedStop {
  double from_s = 0.0, to_s = 0.0;
  Eigen::Vector3d force_m_s2 = Eigen::Vector3d::Zero(),
                  rate_rad_s = Eigen::Vector3d::Zero();  // means, as measured
  double residual_m_s2 = 0.0,
         sigma_m_s2 = 0.0;  // of |M^-1 (f - b)| minus gravity, with the current parameters
  bool used = true;
};

// Data of one IMU.
struct MaintainedImu {
  std::string name, stream;
  double from_s = 0.0, to_s = 0.0, rate_hz = 0.0;
  std::vector<MaintainedStop> stops;
  std::string weakest;  // the direction that stops constrain least; empty without stops
  double weakest_sigma = 0.0;
  double misfit = 0.0;  // RMS of the stops' normalised residuals; 0: too few stops
};

// A quantity over time, number by number.
struct TrackedNumber {
  std::string name;  // "x"; empty for scalar quantities
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

// True if a step is visible in a track: a step of the same pair, or of the IMU that the track is relative to.
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
