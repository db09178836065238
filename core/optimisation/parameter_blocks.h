// The batch's unknowns as Ceres moves them: blocks of numbers that stay where they are, and the state that
// they stand for.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/optimisation/free_intrinsics.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/spline_segment.h"

#include <array>
#include <memory>
#include <vector>

namespace evical {

// One calibrated quantity's parameter block; names without the sensor's name.
enum class QuantityKind {
  CameraRotation,
  CameraTranslation,
  CameraTimeOffset,
  EdgeLead,
  EdgeLeadGrowth,
  CameraIntrinsics,
  ImuRotation,
  ImuTranslation,
  ImuTimeOffset,
  GyroscopeBias,
  AccelerometerBias,
  GyroscopeMapping,
  AccelerometerMapping,
  GyroscopeRotation,
  GravityDirection,
};
struct Quantity {
  QuantityKind kind;
  std::size_t sensor;
  double* block;
};

class ParameterBlocks {
 public:
  // What is given goes in place of what `initial` has.
  ParameterBlocks(const CalibrationInput& input, const OptimisationOptions& options,
                  const CalibrationState& initial);
  ParameterBlocks(const ParameterBlocks&) = delete;
  ParameterBlocks& operator=(const ParameterBlocks&) = delete;

  // What the blocks hold now.
  CalibrationState state() const;

  // Its numbers are the blocks themselves, so that lists must keep their sizes; save mappings and intrinsics,
  // whose blocks follow.
  CalibrationState& moved() { return moved_; }
  const CalibrationState& moved() const { return moved_; }
  double* gyroscopeMapping(std::size_t imu) { return gyroscope_mappings_[imu].data(); }
  double* accelerometerMapping(std::size_t imu) { return accelerometer_mappings_[imu].data(); }
  IntrinsicsBlock* intrinsics(std::size_t camera) {
    return intrinsics_[camera].get();
  }  // null if they are fixed

  SegmentTimes segmentAt(double time_s) const;
  void appendRotation(const SegmentTimes& segment, std::vector<double*>& blocks);
  void appendPosition(const SegmentTimes& segment, std::vector<double*>& blocks);

  std::vector<Quantity> quantities();
  std::vector<Quantity> biasKnots();     // by IMU, gyroscopes first, in order of time
  std::vector<double*> controlPoints();  // of both splines, in order of time

 private:
  CalibrationState moved_;
  std::vector<std::array<double, 6>> gyroscope_mappings_, accelerometer_mappings_;  // by IMU
  std::vector<std::unique_ptr<IntrinsicsBlock>> intrinsics_;                        // by camera
};

}  // namespace evical
