// Whether logs of IMUs are in the units that they say, by what they measure. Each throws CalibrationError (BadInput) that says
// what to give.
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

// Forces in g or thousandths of it, rates in deg/s.
void checkUnits(const ImuMeans& imu);

// Of an IMU beside another on one body: forces that point against each other. `later_s` is added to its own times.
void checkDirection(const ImuMeans& own, const ImuMeans& reference,
                    const Eigen::Quaterniond& reference_from_own, double later_s);

}  // namespace evical
