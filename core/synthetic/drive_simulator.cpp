#include "core/synthetic/drive_simulator.h"

#include "core/base/time.h"
#include "core/geometry/so3.h"
#include "core/synthetic/drive_motion.h"
#include "core/synthetic/imu_faults.h"
#include "core/synthetic/random.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

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

}  // namespace evical
