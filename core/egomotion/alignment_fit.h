// The least squares problem of rotation_alignment.h; internal to this folder.
#pragma once

#include "core/egomotion/rotation_alignment.h"

#include "core/data/imu_sample.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace evical {

// Integrated gyroscope samples: means over any interval, which are smooth functions of its beginning and end.
class SummedRates {
 public:
  // Times are converted to seconds since start_ns. Samples in time order.
  SummedRates(std::span<const ImuSample> samples, std::int64_t start_ns);

  // True if samples without a long gap cover the interval.
  bool covers(double from_s, double to_s) const;
  // Linearly interpolated. Only within the covered time.
  Eigen::Vector3d rateAt_rad_s(double time_s) const;
  Eigen::Vector3d mean_rad_s(double from_s, double to_s) const {
    return (sumUntil(to_s) - sumUntil(from_s)) / (to_s - from_s);
  }

 private:
  std::size_t after(double time_s) const;  // index of the first later sample; 1 .. size - 1
  Eigen::Vector3d sumUntil(double time_s) const;

  std::vector<double> times_s_, gaps_s_;  // gaps_s_: beginnings of too long steps
  std::vector<Eigen::Vector3d> rates_rad_s_, sums_rad_;
};

// Rotation about the IMU's axes, time offset, bias, scale.
inline constexpr int kAlignmentNumbers = 8;
using AlignmentVector = Eigen::Matrix<double, kAlignmentNumbers, 1>;
using AlignmentMatrix = Eigen::Matrix<double, kAlignmentNumbers, kAlignmentNumbers>;

struct AlignmentState {
  Eigen::Matrix3d imu_from_camera = Eigen::Matrix3d::Identity();
  double time_offset_s = 0.0;
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();
  double scale = 1.0;
  // Remaining effect of a lever arm l between the camera and the centre of rotation, divided by the scene's
  // depth, if v = w x l is uncertain. It adds (l_x w_z - l_z w_x, l_y w_z - l_z w_y, 0) to the seen rotation.
  // Used in joint_fit.h only.
  Eigen::Vector3d lever_left = Eigen::Vector3d::Zero();
};

class AlignmentFit {
 public:
  // `windows`: the used ones.
  AlignmentFit(std::vector<const WindowMotion*> windows, const SummedRates& rates,
               const Eigen::Matrix3d& gyroscope_matrix);

  // Mean rate of the IMU in the window, in its frame, with the weights of the window's parts; and its
  // derivative by time.
  Eigen::Vector3d imuRate_rad_s(const WindowMotion& window, const AlignmentState& state,
                                Eigen::Vector3d* by_time = nullptr) const;

  // Gauss-Newton from `state`. False if the solution is not determined.
  bool solve(AlignmentState& state);

  // Residuals of each window after the last solve(), in units of their scatter: squares of three numbers.
  const std::vector<double>& squares() const { return squares_; }
  double medianError_rad_s() const { return median_error_rad_s_; }

  const Eigen::Matrix3d& imuFromMeasured() const { return imu_from_measured_; }
  std::size_t windowCount() const { return windows_.size(); }
  const WindowMotion& window(std::size_t k) const { return *windows_[k]; }

 private:
  struct Equation {
    Eigen::Vector3d error;
    Eigen::Matrix<double, 3, kAlignmentNumbers> jacobian;
  };
  struct NormalEquations {
    AlignmentMatrix normal = AlignmentMatrix::Zero();
    AlignmentVector gradient = AlignmentVector::Zero();
  };
  Equation equationOf(std::size_t k, const AlignmentState& state) const;
  NormalEquations normalEquations(const AlignmentState& state) const;
  Eigen::Matrix3d weightOf(std::size_t k, const Eigen::Vector3d& error, double* square = nullptr) const;
  void findScales(const AlignmentState& state);

  std::vector<const WindowMotion*> windows_;
  const SummedRates& rates_;
  Eigen::Matrix3d imu_from_measured_;
  double floor_rad_s_ = 0.01,
         scale_ = 1.0;  // least sigma of a window; ratio of the errors to the sigmas
  double median_error_rad_s_ = 0.0;
  std::vector<double> squares_;
};

// Starting points of the alignment: offsets at which camera and gyroscope rotate equally fast, each with the
// best rotation. Internal to this folder.

// `start` first, then the others in order of correlation.
std::vector<AlignmentState> alignmentStarts(const std::vector<const WindowMotion*>& windows,
                                            const AlignmentFit& fit, const SummedRates& rates,
                                            const AlignmentState& start, double search_s);

}  // namespace evical
