#include "core/synthetic/drive_motion.h"

#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/synthetic/random.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace evical {
namespace {

constexpr double kRamp_s = 1.0;  // rise and fall time of the envelope

// Smooth step from 0 to 1 over u = 0 to 1, flat to the second order at both ends; with derivatives by u.
MotionValue smoothStep(double u) {
  if (u <= 0.0) return {0.0, 0.0, 0.0};
  if (u >= 1.0) return {1.0, 0.0, 0.0};
  return {u * u * u * (10.0 + u * (6.0 * u - 15.0)), 30.0 * u * u * (1.0 - u) * (1.0 - u),
          60.0 * u * (1.0 - u) * (1.0 - 2.0 * u)};
}

MotionValue overTime(double since_s, double length_s) {
  const MotionValue step = smoothStep(since_s / length_s);
  return {step.value, step.first / length_s, step.second / (length_s * length_s)};
}

MotionValue product(const MotionValue& a, const MotionValue& b) {
  return {a.value * b.value, a.first * b.value + a.value * b.first,
          a.second * b.value + 2.0 * a.first * b.first + a.value * b.second};
}

MotionValue sumOf(const std::vector<MotionSinusoid>& sinusoids, double time_s) {
  MotionValue sum;
  for (const MotionSinusoid& each : sinusoids) sum += each.at(time_s);
  return sum;
}

// Adds a rotation about an axis of the body.
void turnOnTop(MotionState& state, const Eigen::Vector3d& axis, const MotionValue& angle) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle.value, axis));
  const Eigen::Vector3d w = turn.conjugate() * state.angular_velocity_in_body_rad_s,
                        dw = turn.conjugate() * state.angular_acceleration_in_body_rad_s2;
  state.world_from_body.rotation = state.world_from_body.rotation * turn;
  state.angular_velocity_in_body_rad_s = w + angle.first * axis;
  state.angular_acceleration_in_body_rad_s2 = dw + w.cross(angle.first * axis) + angle.second * axis;
}

// Frequencies evenly spread in the logarithm, so that no two axes move together.
std::vector<MotionSinusoid> sinusoids(double rms, double lowest_hz, double highest_hz, Random random) {
  constexpr int kCount = 4;
  std::vector<MotionSinusoid> all;
  for (int k = 0; k < kCount; ++k) {
    const double frequency_hz = lowest_hz * std::pow(highest_hz / lowest_hz, (k + random.uniform()) / kCount);
    all.push_back({rms * std::sqrt(2.0 / kCount), kTwoPi * frequency_hz, kTwoPi * random.uniform()});
  }
  return all;
}

}  // namespace

DriveMotionModel::DriveMotionModel(const DriveScenario& scenario) : motion_(scenario.motion) {
  constexpr std::uint64_t kWobble = 0x310, kSway = 0x320;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    wobble_[axis] = sinusoids(motion_.wobble_rad[a], motion_.lowest_wobble_hz, motion_.highest_wobble_hz,
                              Random(scenario.seed, kWobble, axis));
    sway_[axis] = sinusoids(motion_.sway_m[a], motion_.lowest_sway_hz, motion_.highest_sway_hz,
                            Random(scenario.seed, kSway, axis));
  }
}

// Each cycle begins with a stop.
MotionValue DriveMotionModel::moving(double time_s) const {
  if (motion_.stops == 0) return {1.0, 0.0, 0.0};
  const double cycle = std::floor(time_s / motion_.cycle_s());
  if (cycle < 0.0 || cycle >= motion_.stops) return {0.0, 0.0, 0.0};
  const double since_s = time_s - cycle * motion_.cycle_s() - motion_.stop_s;
  const MotionValue up = overTime(since_s, kRamp_s);
  const MotionValue down = overTime(since_s - motion_.drive_s + kRamp_s, kRamp_s);
  return {up.value - down.value, up.first - down.first, up.second - down.second};
}

// Directions of up in the body on a spiral of equal areas, within the largest tilt from the first one.
Eigen::Quaterniond DriveMotionModel::attitude(long stop) const {
  const long count = std::max(motion_.attitudes, 1), k = stop % count;
  if (k == 0) return Eigen::Quaterniond::Identity();
  const double lowest = std::cos(motion_.tilt_rad);
  const double height = 1.0 - (1.0 - lowest) * static_cast<double>(k) / static_cast<double>(count - 1);
  const double around = std::numbers::pi * (3.0 - std::sqrt(5.0)) * static_cast<double>(k);
  const double angle = std::acos(std::clamp(height, -1.0, 1.0));
  return Eigen::Quaterniond(
      Eigen::AngleAxisd(angle, Eigen::Vector3d(std::cos(around), std::sin(around), 0.0)));
}

MotionState DriveMotionModel::turning(double time_s) const {
  MotionState state;
  state.velocity_in_world_m_s = state.acceleration_in_world_m_s2 = Eigen::Vector3d::Zero();
  state.angular_velocity_in_body_rad_s = state.angular_acceleration_in_body_rad_s2 = Eigen::Vector3d::Zero();
  if (motion_.stops == 0) return state;
  const double cycle = std::clamp(std::floor(time_s / motion_.cycle_s()), 0.0, motion_.stops - 1.0);
  const long stop = static_cast<long>(cycle);
  const Eigen::Quaterniond from = attitude(stop);
  const Eigen::Vector3d way = quaternionLog(from.conjugate() * attitude(stop + 1));
  state.world_from_body.rotation = from;
  const double angle = way.norm();
  if (angle < 1e-12) return state;
  const MotionValue done = overTime(time_s - cycle * motion_.cycle_s() - motion_.stop_s, motion_.drive_s);
  turnOnTop(state, way / angle, {angle * done.value, angle * done.first, angle * done.second});
  return state;
}

MotionState DriveMotionModel::at(double time_s) const {
  MotionState state = turning(time_s);
  const MotionValue envelope = moving(time_s);
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    turnOnTop(state, Eigen::Vector3d::Unit(axis), product(envelope, sumOf(wobble_[a], time_s)));
    const MotionValue place = product(envelope, sumOf(sway_[a], time_s));
    state.world_from_body.translation_m[axis] = place.value;
    state.velocity_in_world_m_s[axis] = place.first;
    state.acceleration_in_world_m_s2[axis] = place.second;
  }
  return state;
}

}  // namespace evical
