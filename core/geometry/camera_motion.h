// A camera's pose on a trajectory, from the control points of a few successive segments, with its
// derivatives.
#pragma once

#include "core/geometry/so3.h"
#include "core/geometry/spline_segment.h"

#include "core/numerics/angles.h"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace evical {

class CameraMotion {
 public:
  // `points`: rotations (x y z w), then positions. Keeps references.
  CameraMotion(const SegmentTimes& segments, double const* const* points,
               const Eigen::Matrix3d& imu_from_camera, const Eigen::Vector3d& camera_in_imu,
               RotationOrder order, bool with_jacobians)
      : segments_(segments),
        points_(points),
        imu_from_camera_(imu_from_camera),
        camera_in_imu_(camera_in_imu),
        order_(order),
        with_jacobians_(with_jacobians) {}

  void moveTo(double time_s) {
    if (time_s == time_s_) return;
    time_s_ = time_s;
    const SplinePlace turn = placeInSpline(segments_.rotation_start_s, segments_.rotation_spacing_s,
                                           segments_.rotations, time_s),
                      shift = placeInSpline(segments_.position_start_s, segments_.position_spacing_s,
                                            segments_.positions, time_s);
    if (!turns_ || turn.segment != turn_at_)
      turns_.emplace(rotationSegment(segments_, points_ + turn.segment, with_jacobians_));
    turn_at_ = turn.segment;
    shift_at_ = shift.segment;
    turns_->evaluate(turn.u, order_, rotation_, with_jacobians_ ? &by_points_ : nullptr);
    double const* const* p = points_ + rotationPointsOf(segments_) + shift_at_;
    position_ = evaluateVectorSegment(p[0], p[1], p[2], p[3], shift.u, segments_.position_spacing_s);
    camera_from_world = (rotation_.rotation * imu_from_camera_).transpose();
    camera_in_world = position_.value + rotation_.rotation * camera_in_imu_;
  }

  // In the camera's frame.
  Eigen::Vector3d angularVelocity() const {
    return imu_from_camera_.transpose() * rotation_.angular_velocity_rad_s;
  }
  Eigen::Vector3d velocity() const {
    return camera_from_world * position_.velocity +
           imu_from_camera_.transpose() * rotation_.angular_velocity_rad_s.cross(camera_in_imu_);
  }

  // Derivatives of the pose: of a turn about the camera's axes, then of a shift along them. Columns: control
  // points, and the camera's rotation and translation in the IMU's frame if they are free.
  template <class Matrix>
  void writeDerivatives(bool free_rotation, bool free_translation, Matrix&& by) const {
    by.setZero();
    const Eigen::Matrix3d camera_from_imu = imu_from_camera_.transpose();
    const Eigen::Matrix3d by_lever = -camera_from_imu * skew(camera_in_imu_);
    for (int k = 0; k < 4; ++k) {
      const Eigen::Matrix3d& turn = by_points_.rotation[static_cast<std::size_t>(k)];
      by.template block<3, 3>(0, 3 * (turn_at_ + k)).noalias() = camera_from_imu * turn;
      by.template block<3, 3>(3, 3 * (turn_at_ + k)).noalias() = by_lever * turn;
    }
    Eigen::Index at = 3 * static_cast<Eigen::Index>(rotationPointsOf(segments_));
    for (int k = 0; k < 4; ++k)
      by.template block<3, 3>(3, at + 3 * (shift_at_ + k)) = position_.value_weights[k] * camera_from_world;
    at += 3 * static_cast<Eigen::Index>(positionPointsOf(segments_));
    if (free_rotation) by.template block<3, 3>(0, at).setIdentity();
    if (free_translation) by.template block<3, 3>(3, at + (free_rotation ? 3 : 0)) = camera_from_imu;
  }

  Eigen::Matrix3d camera_from_world;
  Eigen::Vector3d camera_in_world;

 private:
  const SegmentTimes& segments_;
  double const* const* points_;
  const Eigen::Matrix3d& imu_from_camera_;
  const Eigen::Vector3d& camera_in_imu_;
  RotationOrder order_;
  bool with_jacobians_;
  double time_s_ = std::numeric_limits<double>::quiet_NaN();
  std::optional<So3Segment> turns_;
  int turn_at_ = 0, shift_at_ = 0;
  RotationSample rotation_;
  RotationJacobians by_points_;
  VectorSample position_;
};

// Times between which the derivatives of poses on a trajectory are interpolated, for measurements within a
// short while.

// Chebyshev's times; none if control points are the better columns. Weights of control points have slopes up
// to 2/3, second derivatives up to 2 and third ones up to 3, in knots. With a half the length, 2/3 a, 2 a^2 /
// 4 and 3 a^3 / 24 remain after one, two and three times. The limits leave less than 1e-3, also where the
// errors of several control points add up.
struct PoseTimes {
  static constexpr std::size_t kMax = 3;
  // Longest views with one, two and three times.
  static constexpr std::array<double, kMax> kLongest_knots = {6e-4, 0.045, 0.24};
  std::size_t count = 0;
  std::array<double, kMax> times_s{};

  PoseTimes() = default;
  PoseTimes(double first_s, double last_s, double knot_spacing_s) {
    const double length_s = last_s - first_s;
    if (length_s > longest_s(knot_spacing_s)) return;
    while (length_s > kLongest_knots[count] * knot_spacing_s) ++count;
    ++count;
    for (std::size_t k = 0; k < count; ++k)
      times_s[k] =
          0.5 * (first_s + last_s +
                 length_s * std::cos(kPi * (static_cast<double>(k) + 0.5) / static_cast<double>(count)));
  }
  static double longest_s(double knot_spacing_s) { return kLongest_knots.back() * knot_spacing_s; }

  // Lagrange's polynomials.
  std::array<double, kMax> weightsAt(double time_s) const {
    std::array<double, kMax> weights{};
    for (std::size_t i = 0; i < count; ++i) {
      weights[i] = 1.0;
      for (std::size_t k = 0; k < count; ++k)
        if (k != i) weights[i] *= (time_s - times_s[k]) / (times_s[i] - times_s[k]);
    }
    return weights;
  }
};

}  // namespace evical
