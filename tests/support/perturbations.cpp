#include "tests/support/perturbations.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/geometry/camera_model.h"
#include "core/numerics/angles.h"
#include "core/synthetic/imu_simulator.h"
#include "core/synthetic/sinusoid_motion.h"
#include "tests/support/seen_through.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <random>

namespace evical::test {
namespace {

std::vector<ImuSample>& samplesOf(Recorded& recorded) {
  return recorded.pass.imus.front().samples;
}

template <class Change>
void changeSamples(Recorded& recorded, Change&& change) {
  for (ImuSample& sample : samplesOf(recorded)) change(sample);
}

void simulateImuAnew(Recorded& recorded) {
  samplesOf(recorded) = simulateImu(recorded.scenario, 0);
}

std::int64_t middle_ns(const std::vector<ImuSample>& samples) {
  return samples.front().time_ns + (samples.back().time_ns - samples.front().time_ns) / 2;
}

void sortByTime(std::vector<ImuSample>& samples) {
  std::stable_sort(samples.begin(), samples.end(),
                   [](const ImuSample& a, const ImuSample& b) { return a.time_ns < b.time_ns; });
  const auto same = [](const ImuSample& a, const ImuSample& b) { return a.time_ns == b.time_ns; };
  samples.erase(std::unique(samples.begin(), samples.end(), same), samples.end());
}

// --- the board

// Moves every circle to where it is seen if the board's points lie `displacement(point)` from where they should.
template <class Displacement>
void deformBoard(Recorded& recorded, Displacement&& displacement) {
  const SinusoidMotion motion(recorded.scenario);
  for (std::size_t k = 0; k < recorded.pass.cameras.size(); ++k) {
    const SimulatedCamera& camera = recorded.scenario.cameras[k];
    CameraIntrinsics ideal = *recorded.pass.lenses[k].seen_with;
    ideal.distortion = {};
    ideal.model = CameraModel::PinholeRadtan;
    for (BoardView& view : recorded.pass.cameras[k].views) {
      for (CircleObservation& circle : view.circles) {
        const double time_s = circle.time_s + camera.time_offset_s - camera.pixel.delay_s();
        const RigidTransform camera_from_world = inverse(motion.worldFromCamera(k, time_s));
        const Eigen::Vector2d on_board_m = recorded.scenario.board.centre_m(circle.circle);
        const Eigen::Vector3d point_m(on_board_m.x(), on_board_m.y(), 0.0);
        const auto seen = project(ideal, camera_from_world * (point_m + displacement(point_m)).eval());
        const auto expected = project(ideal, camera_from_world * point_m);
        if (seen && expected) circle.centre_px += *seen - *expected;
      }
    }
  }
}

void spacing(Recorded& recorded, double percent) {
  recorded.session.board.spacing_m *= 1.0 + 0.01 * percent;
  recorded.session.board.radius_m *= 1.0 + 0.01 * percent;
}

void stretch(Recorded& recorded, double percent) {
  deformBoard(recorded, [&](const Eigen::Vector3d& point_m) {
    return Eigen::Vector3d(0.0, 0.01 * percent * point_m.y(), 0.0);
  });
}

// Its middle stands out by this, as of paper that has come off in the middle: a parabola along the columns.
void bow(Recorded& recorded, double height_mm) {
  const CircleBoard& board = recorded.scenario.board;
  const double length_m = board.centre_m(board.rows - 1, 0).y();
  deformBoard(recorded, [&](const Eigen::Vector3d& point_m) {
    const double u = 2.0 * point_m.y() / length_m - 1.0;
    return Eigen::Vector3d(0.0, 0.0, -1e-3 * height_mm * (1.0 - u * u));
  });
}

void rows(Recorded& recorded, double more) {
  recorded.session.board.rows += static_cast<int>(more);
}
void cols(Recorded& recorded, double more) {
  recorded.session.board.cols += static_cast<int>(more);
}

// --- gravity

void gravityNorm(Recorded& recorded, double norm_m_s2) {
  recorded.scenario.gravity_in_world_m_s2 *= norm_m_s2 / recorded.scenario.gravity_in_world_m_s2.norm();
  simulateImuAnew(recorded);
}

// --- the lens

// What the session says; circles are then those that the front end sees through it.
template <class Change>
void changeLens(Recorded& recorded, Change&& change) {
  for (std::size_t k = 0; k < recorded.pass.cameras.size(); ++k) {
    const CameraIntrinsics truth = *recorded.pass.lenses[k].seen_with;
    CameraIntrinsics said = truth;
    change(said);
    recorded.session.cameras[k].intrinsics = said;
    recorded.pass.lenses[k] = givenLens(said);
    seeThrough(truth, said, recorded.pass.cameras[k]);
  }
}

void focalLength(Recorded& recorded, double percent) {
  changeLens(recorded, [&](CameraIntrinsics& lens) { lens.focal_length_px *= 1.0 + 0.01 * percent; });
}
void focalLengthX(Recorded& recorded, double percent) {
  changeLens(recorded, [&](CameraIntrinsics& lens) { lens.focal_length_px.x() *= 1.0 + 0.01 * percent; });
}
void centre(Recorded& recorded, double shift_px) {
  changeLens(recorded, [&](CameraIntrinsics& lens) { lens.principal_point_px.x() += shift_px; });
}
void swappedCentre(Recorded& recorded, double) {
  changeLens(recorded, [](CameraIntrinsics& lens) {
    std::swap(lens.principal_point_px.x(), lens.principal_point_px.y());
  });
}
void distortion(Recorded& recorded, double share) {
  changeLens(recorded, [&](CameraIntrinsics& lens) {
    for (double& coefficient : lens.distortion) coefficient *= share;
  });
}

// --- clocks

// The IMU's stamps run fast by this; truth is the offset in the middle.
void drift(Recorded& recorded, double ppm) {
  std::vector<ImuSample>& samples = samplesOf(recorded);
  const std::int64_t about_ns = middle_ns(samples);
  for (ImuSample& sample : samples)
    sample.time_ns += std::llround(1e-6 * ppm * static_cast<double>(sample.time_ns - about_ns));
}

// Truth is the larger, first part's offset.
void clockStep(Recorded& recorded, double step_ms) {
  constexpr double kFrom = 0.6;
  std::vector<ImuSample>& samples = samplesOf(recorded);
  const auto from = static_cast<std::size_t>(kFrom * static_cast<double>(samples.size()));
  for (std::size_t k = from; k < samples.size(); ++k) samples[k].time_ns += std::llround(1e6 * step_ms);
  sortByTime(samples);
}

void offset(Recorded& recorded, double offset_s) {
  for (SimulatedCamera& camera : recorded.scenario.cameras) camera.time_offset_s += offset_s;
  changeSamples(recorded, [&](ImuSample& sample) { sample.time_ns += std::llround(1e9 * offset_s); });
}

void jitter(Recorded& recorded, double sigma_ms) {
  std::mt19937_64 generator(recorded.scenario.seed);
  std::normal_distribution<double> normal(0.0, sigma_ms);
  changeSamples(recorded,
                [&](ImuSample& sample) { sample.time_ns += std::llround(1e6 * normal(generator)); });
  sortByTime(samplesOf(recorded));
}

// --- the IMU

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
// The next axis for each: a rotation of 120 degrees, so that nothing is mirrored.
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

// At this share of what the fastest axis reaches.
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

std::size_t anySample(Recorded& recorded, std::mt19937_64& generator) {
  return std::uniform_int_distribution<std::size_t>(0, samplesOf(recorded).size() - 1)(generator);
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

// Samples that are no numbers, which do not get past whoever reads a recording (SessionRecording).
void notNumbers(Recorded& recorded, double count) {
  std::mt19937_64 generator(recorded.scenario.seed);
  for (int k = 0; k < static_cast<int>(count); ++k)
    samplesOf(recorded).erase(samplesOf(recorded).begin() +
                              static_cast<std::ptrdiff_t>(anySample(recorded, generator)));
}

// Of another run of the same rig.
void otherImu(Recorded& recorded, double) {
  Scenario other = recorded.scenario;
  other.seed += 1000;
  samplesOf(recorded) = simulateImu(other, 0);
}

void lostSamples(Recorded& recorded, double percent) {
  std::mt19937_64 generator(recorded.scenario.seed);
  std::uniform_real_distribution<double> uniform(0.0, 100.0);
  std::erase_if(samplesOf(recorded), [&](const ImuSample&) { return uniform(generator) < percent; });
}

// Runs of samples, as a packet holds them: 50 ms each.
void lostPackets(Recorded& recorded, double count) {
  constexpr std::int64_t kLength_ns = 50'000'000;
  std::mt19937_64 generator(recorded.scenario.seed);
  for (int k = 0; k < static_cast<int>(count); ++k) {
    const std::int64_t from_ns = samplesOf(recorded)[anySample(recorded, generator)].time_ns;
    std::erase_if(samplesOf(recorded), [&](const ImuSample& sample) {
      return sample.time_ns > from_ns && sample.time_ns < from_ns + kLength_ns;
    });
  }
}

void nothing(Recorded&, double) {}

const std::vector<Perturbation>& table() {
  using enum PerturbedStage;
  static const std::vector<Perturbation> rows_of_table = {
      {"none", "", {0}, {}, nothing},
      {"board spacing", "%", {0.5, 1, 2, -1, -2.5}, {"spacing", "board's scale"}, spacing},
      {"board stretch", "%", {0.25, 0.5, 1}, {"stretch", "board's shape", "ratio"}, stretch},
      {"board bow", "mm", {0.5, 1, 2}, {"bow", "bent", "flat", "board's shape"}, bow},
      {"board rows", "", {2, -2}, {"rows"}, rows, FrontEnd},
      {"board cols", "", {1, -1}, {"cols"}, cols, FrontEnd},
      {"gravity", "m/s^2", {9.78, 9.83, 9.9}, {"gravity"}, gravityNorm},
      {"focal length", "%", {0.3, 1, 5}, {"lens", "focal", "intrinsics"}, focalLength},
      {"focal length x", "%", {0.3, 1, 3}, {"lens", "focal", "intrinsics"}, focalLengthX},
      {"centre", "px", {1, 2, 10}, {"lens", "principal", "intrinsics"}, centre},
      {"swapped centre", "", {1}, {"lens", "principal", "intrinsics"}, swappedCentre},
      {"distortion", "of truth", {0.9, 0.5, 0}, {"lens", "distortion", "intrinsics"}, distortion},
      {"clock drift", "ppm", {50, 200, 1000}, {"drift"}, drift},
      {"clock step", "ms", {1, 10, 50, 100}, {"step", "clock"}, clockStep},
      {"time offset", "s", {0.7, 1.5, 5, 30}, {"time offset", "clock"}, offset},
      {"stamp jitter", "ms", {1, 5}, {"stamp", "interval", "jitter"}, jitter},
      {"accelerometer late", "ms", {1, 3, 5}, {"delay", "late"}, accelerometerLate},
      {"gyroscope turned", "deg", {0.3, 1, 3}, {"gyroscope seems to be turned"}, gyroscopeTurned},
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
      {"lost samples", "%", {10, 50, 90}, {"lost", "gap", "no samples"}, lostSamples},
      {"lost packets", "", {1, 5, 20}, {"lost", "gap", "no samples"}, lostPackets}};
  return rows_of_table;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

}  // namespace

bool Perturbation::isNamedIn(std::string_view reason) const {
  const std::string text = lower(reason);
  return std::any_of(causes.begin(), causes.end(),
                     [&](std::string_view cause) { return text.find(lower(cause)) != std::string::npos; });
}

std::span<const Perturbation> perturbations() {
  return table();
}

const Perturbation& perturbation(std::string_view name) {
  for (const Perturbation& each : table())
    if (each.name == name) return each;
  std::string names;
  for (const Perturbation& each : table()) names += (names.empty() ? "" : ", ") + std::string(each.name);
  throw badInput("perturbation", "there is none called " + std::string(name), "There are " + names);
}

std::string_view firstReason(std::string_view reason) {
  return reason.substr(0, reason.find("; "));
}

}  // namespace evical::test
