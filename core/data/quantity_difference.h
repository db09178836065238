// Differences between two estimates of one rig, quantity by quantity.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/calibration_state.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace evical {

// An estimate without its trajectory, or the truth. The lists are parallel: one uncertainty per sensor and
// further board.
struct Estimate {
  std::string reference;
  std::vector<std::string> camera_names, imu_names;
  std::vector<CameraState> cameras;
  std::vector<ImuState> imus;
  std::vector<std::string> board_names = {"board"};  // the world's, then further boards
  std::vector<BoardState> boards = std::vector<BoardState>(1);
  Eigen::Vector3d gravity_in_world_m_s2 = Eigen::Vector3d::Zero();
  UncertaintyReport uncertainty;
};

// a - b of all quantities in both, in display units; rotations as the vector Log(a * b^-1), about the
// reference's axes. Sigmas are those of `a`. Throws CalibrationError (BadInput) if a sensor is missing in
// `b`, or if its reference is different.
std::vector<QuantityDifference> difference(const Estimate& a, const Estimate& b);

// `b` for a comparison with `a`. If both have a single camera, or a single IMU, it is the same sensor: `b`
// gets its name from `a`, and a note states it.
struct MatchedEstimate {
  Estimate estimate;
  std::vector<std::string> notes;
};
MatchedEstimate matchedByPlace(const Estimate& a, Estimate b);

double gravityDirectionDifference_rad(const Estimate& a, const Estimate& b);

// Index in `b` of the sensor with this name in `a`. Throws as above.
std::size_t sensorIndex(const std::string& name, const std::vector<std::string>& names, const char* key);

// Sigma of the difference of two independent estimates.
UncertaintyReport differenceUncertainty(const UncertaintyReport& a, const UncertaintyReport& b);

// RMS of normalised differences over the quantities that have a sigma; 0 if there are none.
double normalisedRms(const std::vector<QuantityDifference>& quantities);

}  // namespace evical
