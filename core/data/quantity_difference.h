// How far two estimates of one rig are apart, quantity by quantity.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/calibration_state.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace evical {

// An estimate without its trajectory, or what is true. Lists run parallel: as many uncertainties as sensors
// and further boards.
struct Estimate {
  std::string reference;
  std::vector<std::string> camera_names, imu_names;
  std::vector<CameraState> cameras;
  std::vector<ImuState> imus;
  std::vector<std::string> board_names = {"board"};  // the world's, then the further ones
  std::vector<BoardState> boards = std::vector<BoardState>(1);
  Eigen::Vector3d gravity_in_world_m_s2 = Eigen::Vector3d::Zero();
  UncertaintyReport uncertainty;
};

// a - b of all that both have, in units for people; rotations as the vector Log(a * b^-1), about the
// reference's axes. Sigmas are those of `a`. Throws CalibrationError (BadInput) when `b` lacks one of the
// sensors, or has another reference.
std::vector<QuantityDifference> difference(const Estimate& a, const Estimate& b);

double gravityDirectionDifference_rad(const Estimate& a, const Estimate& b);

// The sensor of this name in `b`, whose index in `a` may be another. Throws as above.
std::size_t sensorIndex(const std::string& name, const std::vector<std::string>& names, const char* key);

// Of the difference of two estimates that know nothing of each other.
UncertaintyReport differenceUncertainty(const UncertaintyReport& a, const UncertaintyReport& b);

// RMS of difference by sigma over the quantities that have a sigma; 0 without any.
double normalisedRms(const std::vector<QuantityDifference>& quantities);

}  // namespace evical
