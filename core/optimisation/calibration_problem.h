// The batch's unknowns and cost functions as a Ceres problem. Holds the state that Ceres moves.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/bias_knots.h"
#include "core/optimisation/circle_cost.h"
#include "core/optimisation/inertial_cost.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/pixel_errors.h"
#include "core/optimisation/so3_manifold.h"
#include "core/optimisation/still_axes.h"

#include <ceres/problem.h>
#include <ceres/sphere_manifold.h>

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace evical {

enum class SensorKind { Circles, Gyroscope, Accelerometer, Prior };

// What one residual block of the problem measures, and when.
struct BlockInfo {
  ceres::ResidualBlockId id = nullptr;
  SensorKind kind = SensorKind::Prior;
  std::size_t sensor = 0;  // index of the camera or IMU
  double time_s = 0.0;     // of its first measurement, on the reference IMU's clock
  const CircleCost* circles = nullptr;
};

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

class CalibrationProblem {
 public:
  // Keeps a reference to input and options.
  CalibrationProblem(const CalibrationInput& input, const OptimisationOptions& options,
                     const CalibrationState& initial);
  CalibrationProblem(const CalibrationProblem&) = delete;
  CalibrationProblem& operator=(const CalibrationProblem&) = delete;

  // Assigns every measurement to the spline segment where the time offsets put it now, with the current
  // selection of circles and noise scales.
  void build(ReleaseStages stage);

  ceres::Problem& problem() { return *problem_; }
  const std::vector<BlockInfo>& blocks() const { return blocks_; }

  // How far the time offsets have moved since build(), in knots.
  double segmentDrift_knots() const;

  const CalibrationState& state() const;  // as Ceres left it
  std::vector<Quantity> quantities();     // those free in the built problem
  std::vector<double*> splineBlocks();    // those in the built problem, in order of time
  std::vector<Quantity>
  driftBlocks();  // of biases at their knots: by IMU, gyroscopes first, in order of time

  std::vector<std::vector<std::vector<std::uint8_t>>> used_circles;
  NoiseScales scales;
  // By IMU: along these a mapping stays as it is, and translations stay at 0.
  std::vector<StillAxes> held_axes;

 private:
  void addCircles(std::size_t camera);
  void addImu(std::size_t imu);
  void addGyroscope(std::size_t imu, const SegmentTimes& segment, double time_s,
                    std::span<const ImuSample> samples);
  void addAccelerometer(std::size_t imu, const SegmentTimes& segment, double time_s,
                        std::span<const ImuSample> samples);
  void addPrior(double* block, int size, const double* mean, double sigma);
  void addPriors(ReleaseStages stage);
  void addImuPriors(std::size_t imu);
  void addMappingPriors(std::size_t imu, ReleaseStages stage);
  void addSmoothness();
  void addKnownValues();
  void addKnownPlace(const SensorPrior& prior, RigidTransform& pose, double& time_offset_s);
  void addKnown(double* block, ceres::CostFunction* cost);
  void holdMapping(double* mapping, const std::vector<Eigen::Vector3d>& axes,
                   const std::optional<KnownMapping>& known);
  void holdTranslation(double* translation_m, const std::optional<KnownVector>& known);
  void setManifolds(ReleaseStages stage);
  bool turnsGyroscope(std::size_t imu, ReleaseStages stage) const;
  void holdReferenceCamera();
  bool isReference(std::size_t imu) const { return imu == input_.reference_imu; }
  ImuRole roleOf(std::size_t imu) const { return isReference(imu) ? ImuRole::Reference : ImuRole::Further; }
  SegmentTimes segmentAt(double time_s) const;
  CircleMeasurement measurement(std::size_t camera, std::size_t view, std::size_t circle) const;
  void appendRotationBlocks(const SegmentTimes& segment, std::vector<double*>& blocks);
  void appendPositionBlocks(const SegmentTimes& segment, std::vector<double*>& blocks);

  const CalibrationInput& input_;
  const OptimisationOptions& options_;
  mutable CalibrationState state_;
  std::vector<std::array<double, 6>> gyroscope_mappings_, accelerometer_mappings_;
  std::vector<double> assigned_offsets_s_;  // cameras, then IMUs

  So3Manifold so3_;
  ceres::SphereManifold<3> sphere_;
  std::vector<std::unique_ptr<CircleModel>> circle_models_;
  std::vector<PixelErrors> pixel_errors_;                     // by camera
  std::vector<std::unique_ptr<IntrinsicsBlock>> intrinsics_;  // by camera; none where they are fixed
  std::vector<BlockInfo> blocks_;
  std::unique_ptr<ceres::Problem> problem_;  // after what it points to
};

}  // namespace evical
