// Comparison of an accelerometer with a trajectory: second differences of positions are related to specific
// forces, without velocities. In segments of half a minute or so. docs/maths.md, 15.5. The idea of a fixed
// lag in which velocities are eliminated is from Nemiroff et al. (2023).
#pragma once

#include "core/data/calibration_state.h"
#include "core/data/imu_sample.h"
#include "core/maintenance/maintenance_options.h"
#include "core/maintenance/stop_calibration.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <optional>
#include <vector>

namespace evical {

struct TimedPose {
  double time_s = 0.0;  // on the IMU's clock
  Eigen::Vector3d position_m;
  Eigen::Quaterniond world_from_imu;
};

// Estimate from one segment.
struct LagEstimate {
  double from_s = 0.0, to_s = 0.0;
  AccelerometerVector now;
  AccelerometerMatrix covariance;   // of `now`, from this segment only
  AccelerometerMatrix information;  // at the old numbers
  AccelerometerVector score;
  Eigen::Vector3d gravity_m_s2, lever_m, lever_sigma_m;  // lever: from the poses' origin to the IMU
  double position_noise_m = 0.0;
};

struct LagRows;  // of one segment

class TrajectorySegment {
 public:
  // Poses in order of time.
  TrajectorySegment(std::vector<TimedPose> poses, const ImuState& before, double gravity_m_s2,
                    double accelerometer_density, const MaintenanceOptions& options);

  void add(double time_s, const ImuSample& sample);
  void finish();

  const std::vector<LagEstimate>& lags() const { return lags_; }

 private:
  // Interval between two poses: integrals of the rotated forces, as derivatives by their linear parameters.
  struct Interval {
    double from_s = 0.0, length_s = 0.0;
    Eigen::Matrix<double, 3, kAccelerometerNumbers> velocity, position;
    Eigen::Vector3d from_m, to_m;
    Eigen::Matrix3d from_rotation, to_rotation;
  };

  struct Node {
    double time_s;
    Eigen::Vector3d rate_rad_s, force_m_s2;
    Eigen::Quaterniond rotation;
  };

  std::size_t nextPose(std::size_t from) const;
  double firstStamp_s(double time_s) const;
  double lastStamp_s(double time_s) const;
  void close();
  bool isWhole() const;
  std::vector<Node> nodes() const;
  Interval integrated() const;
  LagRows rows() const;
  void endLag();

  std::vector<TimedPose> poses_;
  ImuState before_;
  double gravity_m_s2_, density_;
  MaintenanceOptions options_;
  std::size_t from_ = 0, to_ = 0;
  std::vector<ImuSample> samples_;
  std::vector<double> times_s_;
  std::vector<Interval> intervals_;
  std::vector<LagEstimate> lags_;
};

// Sum of all segments, at the old numbers; the variance is increased if segments differ by more than their
// sigmas.
struct LagSum {
  AccelerometerMatrix information = AccelerometerMatrix::Zero(), covariance = AccelerometerMatrix::Zero();
  AccelerometerVector score = AccelerometerVector::Zero(), now = AccelerometerVector::Zero();
  double inflation = 1.0;  // of variances
};
LagSum sumOfLags(const std::vector<LagEstimate>& lags, const AccelerometerVector& before);

// Agreement of the rotation of poses with a gyroscope.
struct TurnAgreement {
  Eigen::Quaterniond imu_from_body = Eigen::Quaterniond::Identity();  // the best rotation
  double correlation = 0.0;  // of rates after this rotation; 1: complete agreement
};
// Rotation and agreement of simultaneous angular rates in rad/s: of the trajectory's body, and of the
// gyroscope (equally many).
TurnAgreement turnAgreement(const std::vector<Eigen::Vector3d>& of_body,
                            const std::vector<Eigen::Vector3d>& of_imu);

}  // namespace evical
