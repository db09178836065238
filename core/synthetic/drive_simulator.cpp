#include "core/synthetic/drive_simulator.h"

#include "core/base/time.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/synthetic/imu_simulator.h"
#include "core/synthetic/random.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace evical {
namespace {

struct Measured {
  Eigen::Vector3d rate_rad_s, force_m_s2;
};

// First-order noise: the decayed previous sample, plus new noise so that the variance is constant.
class ShakenMount {
 public:
  ShakenMount(const MountShake& shake, double rate_hz, Random random)
      : shake_(shake), kept_(std::exp(-1.0 / (rate_hz * shake.correlation_s))), random_(random) {
    next(1.0);
  }

  Measured now() const { return {shake_.rate_rad_s * rate_, shake_.force_m_s2 * force_}; }
  void step() { next(std::sqrt(1.0 - kept_ * kept_)); }

 private:
  void next(double share) {
    rate_ = kept_ * rate_ + share * random_.normalVector();
    force_ = kept_ * force_ + share * random_.normalVector();
  }

  MountShake shake_;
  double kept_;
  Random random_;
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero(), force_ = Eigen::Vector3d::Zero();  // of unit size
};

Measured measuredBy(const SimulatedImu& imu, const DriveMotionModel& motion, double time_s,
                    const Eigen::Vector3d& gravity_m_s2) {
  const auto at = [&](double at_s) { return motionOfFrame(motion.at(at_s), imu.reference_from_imu); };
  const MotionState state = at(time_s), delayed = imu.accelerometer_delay_s == 0.0
                                                      ? state
                                                      : at(time_s - imu.accelerometer_delay_s);
  return {imu.gyroscopeMatrix() * state.angular_velocity_in_body_rad_s,
          imu.accelerometer_scale_misalignment * (delayed.world_from_body.rotation.conjugate() *
                                                  (delayed.acceleration_in_world_m_s2 - gravity_m_s2))};
}

// spoilSamples needs a scenario of cameras.
void spoil(const DriveScenario& drive, std::size_t imu, std::vector<ImuSample>& samples) {
  Scenario scenario;
  scenario.seed = drive.seed;
  scenario.duration_s = drive.duration_s;
  scenario.imus = drive.imus;
  spoilSamples(scenario, imu, samples);
}

}  // namespace

std::vector<ImuSample> simulateDriveImu(const DriveScenario& scenario, std::size_t index) {
  constexpr std::uint64_t kNoise = 0x330, kShake = 0x335;
  const DriveMotionModel motion(scenario);
  Random random(scenario.seed, kNoise, index);
  const Eigen::Vector3d gravity_m_s2(0.0, 0.0, -scenario.gravity_m_s2);
  const double rate_hz = scenario.imus[index].rate_hz, root_rate = std::sqrt(rate_hz);
  const auto count = static_cast<std::size_t>(scenario.duration_s * rate_hz);
  std::vector<ImuSample> samples;
  samples.reserve(count);
  Eigen::Vector3d gyroscope_walked = Eigen::Vector3d::Zero(), accelerometer_walked = gyroscope_walked;
  std::size_t steps_done = scenario.steps.size() + 1;
  SimulatedImu imu;
  ShakenMount mount(scenario.imus[index].shake, rate_hz, Random(scenario.seed, kShake, index));
  for (std::size_t k = 0; k < count; ++k) {
    // IMUs do not sample at the same time.
    const double time_s = (static_cast<double>(k) + 0.3 * static_cast<double>(index)) / rate_hz;
    std::size_t done = 0;
    for (const ImuStep& step : scenario.steps) done += step.at_s <= time_s ? 1 : 0;
    if (done != steps_done) imu = scenario.imuAt(index, time_s);
    steps_done = done;
    const Measured now = measuredBy(imu, motion, time_s, gravity_m_s2), shaken = mount.now();
    mount.step();
    ImuSample sample;
    sample.time_ns = scenario.start_ns + nanosecondsFrom(sensorTime_s(imu, time_s));
    sample.angular_rate_rad_s = now.rate_rad_s + shaken.rate_rad_s + imu.gyroscope_bias_rad_s +
                                gyroscope_walked + imu.gyroscope_density * root_rate * random.normalVector();
    sample.specific_force_m_s2 = now.force_m_s2 + shaken.force_m_s2 + imu.accelerometer_bias_m_s2 +
                                 accelerometer_walked +
                                 imu.accelerometer_density * root_rate * random.normalVector();
    samples.push_back(sample);
    gyroscope_walked += imu.gyroscope_walk / root_rate * random.normalVector();
    accelerometer_walked += imu.accelerometer_walk / root_rate * random.normalVector();
  }
  spoil(scenario, index, samples);
  return samples;
}

std::string driveTrajectoryCsv(const DriveScenario& scenario) {
  constexpr std::uint64_t kNoise = 0x340;
  if (scenario.trajectory_hz <= 0.0) return {};
  const DriveMotionModel motion(scenario);
  Random random(scenario.seed, kNoise);
  std::string text = "time_s,x_m,y_m,z_m,qx,qy,qz,qw\n";
  const auto count = static_cast<std::size_t>(scenario.duration_s * scenario.trajectory_hz);
  for (std::size_t k = 0; k < count; ++k) {
    const double time_s = static_cast<double>(k) / scenario.trajectory_hz;
    const MotionState state = motion.at(time_s);
    const Eigen::Vector3d p =
        state.world_from_body.translation_m + scenario.trajectory_noise_m * random.normalVector();
    const Eigen::Quaterniond q =
        state.world_from_body.rotation * quaternionExp(scenario.trajectory_noise_rad * random.normalVector());
    fmt::format_to(std::back_inserter(text), "{:.6f},{:.7f},{:.7f},{:.7f},{:.9f},{:.9f},{:.9f},{:.9f}\n",
                   time_s, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  }
  return text;
}

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
