// Rotation and time offset from all kept edges of all windows at once (docs/maths.md, 16.4). In each window
// the gyroscope gives the camera's rotation, and only its velocity and the depths are estimated. Internal to
// this folder.
#pragma once

#include "core/base/progress.h"
#include "core/egomotion/alignment_fit.h"
#include "core/egomotion/camera_record.h"
#include "core/egomotion/lens_rays.h"
#include "core/egomotion/window_fit.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace evical {

// A camera's rotation during a window, from the gyroscope's measurements. Internal to this folder.

// The numbers of AlignmentState, including lever_left.
inline constexpr int kJointNumbers = kAlignmentNumbers + 3;
using JointVector = Eigen::Matrix<double, kJointNumbers, 1>;
using JointMatrix = Eigen::Matrix<double, kJointNumbers, kJointNumbers>;

// Gyroscope rates during a window: means over its parts, and linear functions between them. Their slope is
// the difference between the window's halves; that of neighbouring parts would be mostly noise.
class WindowRates {
 public:
  WindowRates(const SummedRates& rates, double begin_s, double duration_s) : part_s_(duration_s / kParts) {
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      const double middle_s = begin_s + static_cast<double>(k) * part_s_;
      nodes_[k] = rates.mean_rad_s(middle_s - 0.5 * part_s_, middle_s + 0.5 * part_s_);
    }
    const double half_s = 0.5 * duration_s, middle_s = begin_s + half_s;
    change_rad_s2_ =
        (rates.mean_rad_s(middle_s, middle_s + half_s) - rates.mean_rad_s(begin_s, middle_s)) / half_s;
  }
  Eigen::Vector3d at(double since_begin_s) const {
    const double place = std::clamp(since_begin_s / part_s_, 0.0, kParts - 1e-6);
    const auto k = static_cast<std::size_t>(place);
    return nodes_[k] + (place - static_cast<double>(k)) * (nodes_[k + 1] - nodes_[k]);
  }
  const Eigen::Vector3d& change_rad_s2() const { return change_rad_s2_; }

 private:
  static constexpr int kParts = 8;
  double part_s_;
  std::array<Eigen::Vector3d, kParts + 1> nodes_;
  Eigen::Vector3d change_rad_s2_;
};

// Camera rate for a gyroscope rate, and its derivatives by each number.
class TurningModel {
 public:
  TurningModel(const AlignmentState& state, const Eigen::Matrix3d& imu_from_measured)
      : state_(state), imu_from_measured_(imu_from_measured) {
    const Eigen::Vector3d& l = state.lever_left;
    Eigen::Matrix3d by_lever;
    by_lever << -l.z(), 0.0, l.x(), 0.0, -l.z(), l.y(), 0.0, 0.0, 0.0;
    seen_ = Eigen::Matrix3d::Identity() + by_lever;
    camera_from_imu_ = state.scale * state.imu_from_camera.transpose();
  }

  Eigen::Vector3d cameraRate_rad_s(const Eigen::Vector3d& measured_rad_s) const {
    return seen_ * camera_from_imu_ * inImu(measured_rad_s);
  }

  // Derivative of an error by the numbers, from its derivative by the camera's rate.
  JointVector derivative(const Eigen::Vector3d& measured_rad_s, const Eigen::Vector3d& change_rad_s2,
                         const Eigen::Vector3d& by_rate) const {
    const Eigen::Vector3d in_imu = inImu(measured_rad_s), turned = camera_from_imu_ * in_imu;
    const Eigen::Vector3d by_turned = seen_.transpose() * by_rate;
    const Eigen::Vector3d by_imu = camera_from_imu_.transpose() * by_turned;
    JointVector out;
    out.head<3>() = by_imu.cross(in_imu);
    out[3] = by_imu.dot(imu_from_measured_ * change_rad_s2);
    out.segment<3>(4) = -imu_from_measured_.transpose() * by_imu;
    out[7] = by_turned.dot(turned) / state_.scale;
    out[8] = by_rate.x() * turned.z();
    out[9] = by_rate.y() * turned.z();
    out[10] = -by_rate.x() * turned.x() - by_rate.y() * turned.y();
    return out;
  }

 private:
  Eigen::Vector3d inImu(const Eigen::Vector3d& measured_rad_s) const {
    return imu_from_measured_ * (measured_rad_s - state_.bias_rad_s);
  }

  const AlignmentState& state_;
  const Eigen::Matrix3d& imu_from_measured_;
  Eigen::Matrix3d seen_, camera_from_imu_;
};

struct JointInput {
  const CameraRecord& record;  // used windows covered by the gyroscope
  const LensRays& lens;
  const SummedRates& rates;
  Eigen::Matrix3d imu_from_measured;
  std::int64_t start_ns;  // of the recording
  int threads;
  const RunContext& context;  // for stop requests and progress
};

class JointFit {
 public:
  // `still`: without translation, as if all image motion were rotation.
  JointFit(const JointInput& input, const EgomotionOptions& options, bool still = false);

  // Gauss-Newton from `state`. False if it does not converge. Progress goes from `from` to `to`. Throws
  // Cancelled.
  bool solve(AlignmentState& state, double from, double to);

  // A window's part of the normal equations at the last solution: velocity and depths are eliminated.
  struct Part {
    JointMatrix normal = JointMatrix::Zero();
    JointVector right = JointVector::Zero();
    double middle_s = 0.0;
  };
  const std::vector<Part>& parts() const { return parts_; }
  const JointMatrix& normal() const { return normal_; }  // their sum, with the priors

 private:
  void expectVelocities();
  std::optional<WindowFit> fitWindow(std::size_t k, const TurningModel& model, const WindowRates& rates);
  void findPart(std::size_t k, const AlignmentState& state);
  JointVector sumParts(const AlignmentState& state);

  const JointInput& input_;
  EgomotionOptions options_;
  bool still_;
  double velocity_information_;
  std::vector<const KeptSlopes::Window*> windows_;
  std::vector<WindowState> states_;
  std::vector<Part> parts_;
  JointMatrix normal_ = JointMatrix::Zero();
};

}  // namespace evical
