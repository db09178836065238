// The simulated motion, analytic to its second derivative: sums of sinusoids and hand-held motion, without
// splines.
#pragma once

#include "core/synthetic/scenario.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace evical {

// Additions of hand-held motion to sinusoids (HandModel): tremor, bumps and steps of each quantity, and
// stops, which stretch time.

// A quantity and its derivatives in time.
struct MotionValue {
  double value = 0.0, first = 0.0, second = 0.0;

  MotionValue& operator+=(const MotionValue& other);
};

struct MotionSinusoid {
  double amplitude, angular_frequency, phase;

  MotionValue at(double time_s) const;
};

// Time of the motion as a function of the clock's time: constant during stops. Twice differentiable.
MotionValue motionTime(const HandModel& hand, double time_s);
// Converts derivatives by the motion's time to derivatives by the clock's.
MotionValue throughTime(const MotionValue& value, const MotionValue& time);

// A quick movement there and back.
struct Jerk {
  double size, middle_s;

  MotionValue at(double time_s) const;
};

// Two or three of them, drawn from seed and quantity, at 8 to 12 Hz; none without tremor.
std::vector<MotionSinusoid> tremor(double sigma, std::uint64_t seed, std::size_t quantity);
std::vector<Jerk> jerks(const HandModel& hand, double duration_s, std::uint64_t seed, std::size_t quantity);

// Pose, rates and accelerations of a body frame at one instant.
struct MotionState {
  RigidTransform world_from_body;
  Eigen::Vector3d velocity_in_world_m_s;
  Eigen::Vector3d acceleration_in_world_m_s2;
  Eigen::Vector3d angular_velocity_in_body_rad_s;
  Eigen::Vector3d angular_acceleration_in_body_rad_s2;
};

// The same motion of another frame fixed to the body.
MotionState motionOfFrame(const MotionState& body, const RigidTransform& body_from_frame);

class SinusoidMotion {
 public:
  explicit SinusoidMotion(const Scenario& scenario);

  // State of the reference IMU, at seconds since the scenario's start on its clock.
  MotionState imuAt(double time_s) const;
  MotionState cameraAt(std::size_t camera, double time_s) const;
  RigidTransform worldFromCamera(std::size_t camera, double time_s) const;
  // Pose of the camera relative to its board.
  RigidTransform boardFromCamera(std::size_t camera, double time_s) const;

  // RMS image speed of those of the board's circles that are in the first camera's image.
  double imageSpeedRms_px_s() const;

 private:
  using Sinusoid = MotionSinusoid;
  using Value = MotionValue;
  enum Quantity { AngleX, AngleY, AngleZ, TargetX, TargetY, Distance, WalkX, WalkY, WalkZ, kQuantities };

  void addHand();
  Value at(Quantity quantity, double time_s) const;
  MotionState gazeAt(double time_s) const;  // the first camera without its rotations
  MotionState firstCameraAt(double time_s) const;

  Scenario scenario_;
  Eigen::Vector3d board_middle_m_;
  std::array<std::vector<Sinusoid>, kQuantities> sinusoids_, unstopped_;  // with and without stops
  std::array<std::vector<Jerk>, kQuantities> jerks_;
  RigidTransform camera_from_imu_;  // first camera
};

}  // namespace evical
