// The batch's unknowns as Ceres' parameter blocks with fixed addresses, and the state that they represent.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/data/quantity.h"
#include "core/geometry/spline_segment.h"
#include "core/optimisation/free_intrinsics.h"
#include "core/optimisation/optimisation_options.h"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace evical {

// Parameter block of one calibrated quantity.
struct Quantity {
  const QuantityInfo* info;
  std::size_t sensor;
  double* block;

  QuantityAddress address() const { return {info->owner, sensor, info->id}; }
};

// Columns begin at `first_column` of each, plus the end; nullopt if the number has no column.
std::optional<Eigen::Index> columnOf(const QuantityAddress& number, const std::vector<Quantity>& quantities,
                                     const std::vector<Eigen::Index>& first_column);

class ParameterBlocks {
 public:
  // Given values replace those of `initial`.
  ParameterBlocks(const CalibrationInput& input, const OptimisationOptions& options,
                  const CalibrationState& initial);
  ParameterBlocks(const ParameterBlocks&) = delete;
  ParameterBlocks& operator=(const ParameterBlocks&) = delete;

  // The blocks' current values.
  CalibrationState state() const;

  // The state's numbers are the blocks themselves, so its lists must keep their sizes; mappings and
  // intrinsics have separate blocks, from which they are updated.
  CalibrationState& moved() { return moved_; }
  const CalibrationState& moved() const { return moved_; }

  // The block of a part of moved(); null if it is fixed.
  double* of(double& value) { return &value; }
  double* of(Eigen::Vector3d& value) { return value.data(); }
  double* of(Eigen::Quaterniond& value) { return value.coeffs().data(); }
  double* of(Eigen::Matrix3d& value) { return triangles_.at(&value).data(); }
  double* of(std::optional<CameraIntrinsics>& value);
  // Intrinsics block of the camera's sensor; null if they are fixed.
  IntrinsicsBlock* intrinsics(std::size_t camera) { return intrinsics_[sensorOf(camera)].get(); }

  // The camera whose blocks contain the quantities that cameras of one sensor share; itself if nothing is
  // shared.
  std::size_t sensorOf(std::size_t camera) const { return sensors_[camera]; }
  bool ownsSensor(std::size_t camera) const { return sensors_[camera] == camera; }
  // Copies shared quantities to the cameras without blocks of their own, in moved().
  void followSensors();

  SegmentTimes segmentAt(double time_s) const;
  void appendRotation(const SegmentTimes& segment, std::vector<double*>& blocks);
  void appendPosition(const SegmentTimes& segment, std::vector<double*>& blocks);

  std::vector<Quantity> quantities();
  std::vector<Quantity> biasKnots();     // by IMU, gyroscopes first, in order of time
  std::vector<double*> controlPoints();  // of both splines, in order of time

 private:
  CalibrationState moved_;
  std::map<const Eigen::Matrix3d*, std::array<double, 6>> triangles_;  // of the matrices in moved_
  std::vector<std::unique_ptr<IntrinsicsBlock>> intrinsics_;           // by camera
  std::vector<std::size_t> sensors_;                                   // by camera
};

}  // namespace evical
