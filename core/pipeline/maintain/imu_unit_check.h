// Checks of the units of IMU logs from their values. Each throws CalibrationError (BadInput) with the setting
// to change.
#pragma once

#include "core/maintenance/stop_detection.h"

#include <Eigen/Geometry>

#include <span>
#include <string>

namespace evical {

struct ImuMeans {
  std::string name;
  std::span<const MeansWindow> windows;
};

// Detects forces in g or milli-g, and rates in deg/s.
void checkUnits(const ImuMeans& imu);

// Detects opposite specific forces of two IMUs on one body. `later_s` is added to the own times.
void checkDirection(const ImuMeans& own, const ImuMeans& reference,
                    const Eigen::Quaterniond& reference_from_own, double later_s);

}  // namespace evical
