#include "tests/support/perturbing.h"

#include "core/base/time.h"
#include "core/numerics/angles.h"

#include <Eigen/Geometry>

#include <array>
#include <cmath>

namespace evical::test {
namespace {

Eigen::Vector3d forceAt(const std::vector<ImuSample>& samples, std::int64_t time_ns) {
  const auto after = std::lower_bound(samples.begin(), samples.end(), time_ns,
                                      [](const ImuSample& s, std::int64_t t) { return s.time_ns < t; });
  if (after == samples.begin()) return samples.front().specific_force_m_s2;
  if (after == samples.end()) return samples.back().specific_force_m_s2;
  const ImuSample& before = *(after - 1);
  const double part = secondsSince(before.time_ns, time_ns) / secondsSince(before.time_ns, after->time_ns);
  return (1.0 - part) * before.specific_force_m_s2 + part * after->specific_force_m_s2;
}

void accelerometerLate(Recorded& recorded, double delay_ms) {
  const std::vector<ImuSample> before = samplesOf(recorded);
  changeSamples(recorded, [&](ImuSample& sample) {
    sample.specific_force_m_s2 = forceAt(before, sample.time_ns - std::llround(1e6 * delay_ms));
  });
}

void gyroscopeTurned(Recorded& recorded, double angle_deg) {
  recorded.scenario.imus.front().gyroscope_from_accelerometer =
      Eigen::AngleAxisd(kRadPerDeg * angle_deg, Eigen::Vector3d(1.0, 1.0, 1.0).normalized());
  simulateImuAnew(recorded);
}

void changeBoth(Recorded& recorded, const Eigen::Matrix3d& matrix) {
  changeSamples(recorded, [&](ImuSample& sample) {
    sample.angular_rate_rad_s = matrix * sample.angular_rate_rad_s;
    sample.specific_force_m_s2 = matrix * sample.specific_force_m_s2;
  });
}
Eigen::Matrix3d mirrored(int axis) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix(axis, axis) = -1.0;
  return matrix;
}
Eigen::Matrix3d swapped(int a, int b) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix.col(a).swap(matrix.col(b));
  return matrix;
}

void mirrorBoth(Recorded& recorded, double axis) {
  changeBoth(recorded, mirrored(static_cast<int>(axis)));
}
void swapBoth(Recorded& recorded, double) {
  changeBoth(recorded, swapped(0, 1));
}
void swapGyroscope(Recorded& recorded, double) {
  changeSamples(recorded, [](ImuSample& sample) {
    std::swap(sample.angular_rate_rad_s.x(), sample.angular_rate_rad_s.y());
  });
}
void mirrorGyroscope(Recorded& recorded, double axis) {
  changeSamples(recorded, [&](ImuSample& sample) {
    sample.angular_rate_rad_s = mirrored(static_cast<int>(axis)) * sample.angular_rate_rad_s;
  });
}
// Each axis becomes the next one: a rotation of 120 degrees, so that nothing is mirrored.
void permuteGyroscope(Recorded& recorded, double) {
  changeSamples(recorded, [](ImuSample& sample) {
    const Eigen::Vector3d w = sample.angular_rate_rad_s;
    sample.angular_rate_rad_s = {w.y(), w.z(), w.x()};
  });
}
void negateForces(Recorded& recorded, double) {
  changeSamples(recorded, [](ImuSample& sample) { sample.specific_force_m_s2 *= -1.0; });
}
void negateRates(Recorded& recorded, double) {
  changeSamples(recorded, [](ImuSample& sample) { sample.angular_rate_rad_s *= -1.0; });
}
constexpr double kStandardGravity_m_s2 = 9.80665;

void forcesInG(Recorded& recorded, double) {
  changeSamples(recorded, [](ImuSample& sample) { sample.specific_force_m_s2 /= kStandardGravity_m_s2; });
}
void ratesInDegrees(Recorded& recorded, double) {
  changeSamples(recorded, [](ImuSample& sample) { sample.angular_rate_rad_s *= kDegPerRad; });
}
void deadGyroscope(Recorded& recorded, double axis) {
  changeSamples(recorded, [&](ImuSample& s) { s.angular_rate_rad_s[static_cast<int>(axis)] = 0.0; });
}
void deadAccelerometer(Recorded& recorded, double axis) {
  changeSamples(recorded, [&](ImuSample& s) { s.specific_force_m_s2[static_cast<int>(axis)] = 0.0; });
}

// At this share of the fastest axis's maximum.
void clipRates(Recorded& recorded, double share) {
  double largest = 0.0;
  changeSamples(recorded, [&](const ImuSample& s) {
    largest = std::max(largest, s.angular_rate_rad_s.cwiseAbs().maxCoeff());
  });
  changeSamples(recorded, [&](ImuSample& s) {
    s.angular_rate_rad_s = s.angular_rate_rad_s.cwiseMax(-share * largest).cwiseMin(share * largest).eval();
  });
}
void clipForces(Recorded& recorded, double limit_m_s2) {
  changeSamples(recorded, [&](ImuSample& s) {
    s.specific_force_m_s2 = s.specific_force_m_s2.cwiseMax(-limit_m_s2).cwiseMin(limit_m_s2).eval();
  });
}

void spikes(Recorded& recorded, double count) {
  std::mt19937_64 generator(recorded.scenario.seed);
  std::normal_distribution<double> normal;
  constexpr double kForce_m_s2 = 150.0, kRate_rad_s = 30.0;
  for (int k = 0; k < static_cast<int>(count); ++k) {
    ImuSample& sample = samplesOf(recorded)[anySample(recorded, generator)];
    const double x = normal(generator), y = normal(generator), z = normal(generator);
    const Eigen::Vector3d direction = Eigen::Vector3d(x, y, z).normalized();
    sample.specific_force_m_s2 += kForce_m_s2 * direction;
    sample.angular_rate_rad_s += kRate_rad_s * direction;
  }
}

// Samples that are NaN, which readers of recordings exclude (SessionRecording).
void notNumbers(Recorded& recorded, double count) {
  std::mt19937_64 generator(recorded.scenario.seed);
  for (int k = 0; k < static_cast<int>(count); ++k)
    samplesOf(recorded).erase(samplesOf(recorded).begin() +
                              static_cast<std::ptrdiff_t>(anySample(recorded, generator)));
}

// From another run of the same rig.
void otherImu(Recorded& recorded, double) {
  Scenario other = recorded.scenario;
  other.seed += 1000;
  samplesOf(recorded) = simulateImu(other, 0);
}

void lowPass(Recorded& recorded, double cutoff_hz) {
  simulateFaults(recorded, [&](ImuFaults& faults) { faults.low_pass_hz = cutoff_hz; });
}
void gSensitivity(Recorded& recorded, double rad_s_per_m_s2) {
  simulateFaults(recorded, [&](ImuFaults& faults) { faults.g_sensitivity_rad_s_per_m_s2 = rad_s_per_m_s2; });
}
// The accelerometer's step relative to the gyroscope's, as for 8 g and 500 deg/s in one word.
void coarseSamples(Recorded& recorded, double step_rad_s) {
  constexpr double kForcePerRate = 9.0;
  simulateFaults(recorded, [&](ImuFaults& faults) {
    faults.gyroscope_step_rad_s = step_rad_s;
    faults.accelerometer_step_m_s2 = kForcePerRate * step_rad_s;
  });
}
// Over 50 ms, which no noise density describes.
void wanderingNoise(Recorded& recorded, double rad_s) {
  constexpr double kForcePerRate = 10.0, kTime_s = 0.05;
  simulateFaults(recorded, [&](ImuFaults& faults) {
    faults.gyroscope_wander_rad_s = rad_s;
    faults.accelerometer_wander_m_s2 = kForcePerRate * rad_s;
    faults.wander_time_s = kTime_s;
  });
}
// Drift of the gyroscope, and ten times as large of the accelerometer; the session does not state it.
void walkingBiases(Recorded& recorded, double rad_s2_per_root_hz) {
  constexpr double kForcePerRate = 10.0;
  recorded.scenario.imus.front().gyroscope_walk = rad_s2_per_root_hz;
  recorded.scenario.imus.front().accelerometer_walk = kForcePerRate * rad_s2_per_root_hz;
  simulateImuAnew(recorded);
}
void timesRates(Recorded& recorded, double times) {
  changeSamples(recorded, [&](ImuSample& sample) { sample.angular_rate_rad_s *= times; });
}
void timesForces(Recorded& recorded, double times) {
  changeSamples(recorded, [&](ImuSample& sample) { sample.specific_force_m_s2 *= times; });
}
// Only noise, as of an IMU on the table.
void gyroscopeAtRest(Recorded& recorded, double) {
  std::mt19937_64 generator(recorded.scenario.seed);
  std::normal_distribution<double> noise(0.0, 1e-3);
  changeSamples(recorded, [&](ImuSample& sample) {
    for (double& rate : sample.angular_rate_rad_s) rate = noise(generator);
  });
}
void exchangeSensors(Recorded& recorded, double) {
  changeSamples(recorded,
                [](ImuSample& sample) { std::swap(sample.angular_rate_rad_s, sample.specific_force_m_s2); });
}
void statedNoise(Recorded& recorded, double times) {
  for (ImuNoise* noise : {&recorded.detections.imus.front().noise, &recorded.session.imus.front().noise}) {
    noise->gyroscope_density *= times;
    noise->accelerometer_density *= times;
  }
}

}  // namespace

std::vector<Perturbation> imuPerturbations() {
  return {
      {"accelerometer late", "ms", {1, 3, 5}, {"delay", "late"}, accelerometerLate},
      {"gyroscope turned", "deg", {0.3, 1, 3}, {"gyroscope seems misaligned"}, gyroscopeTurned},
      {"both mirrored", "axis", {0, 1, 2}, {"left-handed", "mirror"}, mirrorBoth},
      {"both swapped", "", {1}, {"left-handed", "swapped"}, swapBoth},
      {"gyroscope swapped", "", {1}, {"left-handed", "swapped", "permuted"}, swapGyroscope},
      {"gyroscope mirrored", "axis", {0, 2}, {"left-handed", "mirror", "negated"}, mirrorGyroscope},
      {"gyroscope permuted", "", {1}, {"permuted", "axes"}, permuteGyroscope},
      {"forces negated", "", {1}, {"negated", "sign", "-g"}, negateForces},
      {"rates negated", "", {1}, {"negated", "sign"}, negateRates},
      {"forces in g", "", {1}, {"acceleration_unit"}, forcesInG},
      {"rates in deg/s", "", {1}, {"angular_rate_unit"}, ratesInDegrees},
      {"gyroscope dead", "axis", {0, 1, 2}, {"dead", "stays at"}, deadGyroscope},
      {"accelerometer dead", "axis", {0, 1, 2}, {"dead", "stays at"}, deadAccelerometer},
      {"rates clipped", "of largest", {0.9, 0.8, 0.6}, {"limit", "clipped", "saturat"}, clipRates},
      {"forces clipped", "m/s^2", {12, 11, 9}, {"limit", "clipped", "saturat"}, clipForces},
      {"spikes", "", {1, 5, 50}, {"spike"}, spikes},
      {"no numbers", "", {1, 10}, {"no number", "finite"}, notNumbers},
      {"another IMU", "", {1}, {"another recording", "other recording"}, otherImu},
      {"low pass", "Hz", {100, 30, 10}, {"filter", "bandwidth", "noise density"}, lowPass},
      {"g-sensitivity", "rad s/m", {1e-5, 1e-4, 3e-4}, {"noise density", "sensitiv"}, gSensitivity},
      {"coarse samples",
       "rad/s",
       {3e-4, 3e-3, 3e-2},
       {"noise density", "steps", "at its limit", "saturated"},
       coarseSamples},
      {"wandering noise",
       "rad/s",
       {1e-3, 3e-3, 1e-2},
       {"noise density", "bias", "has a sigma of"},
       wanderingNoise},
      {"walking biases",
       "rad/s^2",
       {1e-5, 1e-4, 1e-3},
       {"bias", "noise density", "has a sigma of"},
       walkingBiases},
      {"rates times", "", {0.0175, 0.5, 2, 16, 57.3, 1000}, {"angular_rate_unit", "rates are"}, timesRates},
      {"forces times", "", {0.102, 2, 3.28, 9.81, 100, 1000}, {"accelerations is"}, timesForces},
      {"gyroscope at rest", "", {1}, {"at rest"}, gyroscopeAtRest},
      {"sensors exchanged", "", {1}, {"exchanged"}, exchangeSensors},
      {"stated noise", "of truth", {0.001, 0.01, 0.1, 0.33, 3, 57.3, 1e4}, {"noise_density"}, statedNoise}};
}

}  // namespace evical::test
