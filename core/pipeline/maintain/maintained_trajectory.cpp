#include "core/pipeline/maintain/maintained_trajectory.h"

#include "core/base/error.h"
#include "core/base/number.h"
#include "core/base/time.h"
#include "core/geometry/so3.h"
#include "core/maintenance/clock_agreement.h"
#include "core/numerics/angles.h"
#include "core/numerics/robust.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace evical {
namespace {

constexpr double kTurn_s = 0.05;   // distance of poses for angular rates
constexpr double kLook_s = 120.0;  // part of the trajectory for the check of frames and clock

struct BodyRate {
  double from_s, to_s;
  Eigen::Vector3d rate_rad_s;
};

std::vector<BodyRate> ratesOf(const std::vector<TimedPose>& poses,
                              const std::function<Eigen::Quaterniond(const TimedPose&)>& rotation) {
  std::vector<BodyRate> rates;
  std::size_t from = 0;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const double length_s = poses[k].time_s - poses[from].time_s;
    if (length_s < kTurn_s) continue;
    if (length_s < 10.0 * kTurn_s)
      rates.push_back({poses[from].time_s, poses[k].time_s,
                       quaternionLog(rotation(poses[from]).conjugate() * rotation(poses[k])) / length_s});
    from = k;
    if (poses[k].time_s - poses.front().time_s > kLook_s) break;
  }
  return rates;
}

Eigen::Quaterniond unchanged(const TimedPose& pose) {
  return pose.world_from_imu;
}
Eigen::Quaterniond inverted(const TimedPose& pose) {
  return pose.world_from_imu.conjugate();
}
// Quaternion with its numbers read as w, x, y, z instead of x, y, z, w.
Eigen::Quaterniond realPartFirst(const TimedPose& pose) {
  const Eigen::Vector4d& q = pose.world_from_imu.coeffs();
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
}

// Integrated angular rate until each sample, by axis, for means over any interval.
struct TurnedRates {
  std::vector<double> times_s;
  std::vector<Eigen::Vector3d> sums_rad;

  void add(double time_s, const Eigen::Vector3d& rate) {
    if (!times_s.empty() && time_s <= times_s.back()) return;
    const double step_s = times_s.empty() ? 0.0 : time_s - times_s.back();
    sums_rad.push_back((sums_rad.empty() ? Eigen::Vector3d::Zero().eval() : sums_rad.back()) + step_s * rate);
    times_s.push_back(time_s);
  }
  Eigen::Vector3d at(double time_s) const {
    const auto next = std::lower_bound(times_s.begin(), times_s.end(), time_s);
    const auto k = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
        next - times_s.begin(), 1, static_cast<std::ptrdiff_t>(times_s.size()) - 1));
    const double share = (time_s - times_s[k - 1]) / (times_s[k] - times_s[k - 1]);
    return (1.0 - share) * sums_rad[k - 1] + share * sums_rad[k];
  }
  bool holds(const BodyRate& rate) const {
    return times_s.size() > 1 && rate.from_s >= times_s.front() && rate.to_s <= times_s.back();
  }
};

TurnAgreement agreementOf(const std::vector<BodyRate>& rates, const TurnedRates& turned) {
  std::vector<Eigen::Vector3d> body, imu;
  for (const BodyRate& rate : rates) {
    if (!turned.holds(rate)) continue;
    body.push_back(rate.rate_rad_s);
    imu.push_back((turned.at(rate.to_s) - turned.at(rate.from_s)) / (rate.to_s - rate.from_s));
  }
  return turnAgreement(body, imu);
}

// Sensor of the old result with the orientation of the trajectory's body relative to the IMU.
std::string bodyOf(const NamedResult& before, std::size_t imu, const Eigen::Quaterniond& imu_from_body) {
  constexpr double kNear_rad = 2.0 * kRadPerDeg;
  const Eigen::Quaterniond imu_from_reference =
      before.result->state.imus[imu].reference_from_imu.rotation.conjugate();
  const auto is = [&](const RigidTransform& reference_from_sensor) {
    return imu_from_body.angularDistance(imu_from_reference * reference_from_sensor.rotation) < kNear_rad;
  };
  for (std::size_t k = 0; k < before.cameras.size(); ++k)
    if (is(before.result->state.cameras[k].reference_from_camera))
      return "the camera " + before.cameras[k].name;
  for (std::size_t k = 0; k < before.imus.size(); ++k)
    if (k != imu && is(before.result->state.imus[k].reference_from_imu))
      return "the IMU " + before.imus[k].name;
  return {};
}

class TrajectoryCheck {
 public:
  TrajectoryCheck(const MaintainInput& input, std::size_t imu) : input_(input), imu_(imu) {}

  std::string place() const { return input_.trajectory.string(); }
  const std::string& name() const { return input_.before.imus[imu_].name; }

  // Compares times, then rotations.
  double agree(std::vector<TimedPose>& poses, const TurnedRates& turned,
               const AngularSpeedSeries& of_imu) const {
    const std::vector<BodyRate> rates = ratesOf(poses, unchanged);
    if (turned.times_s.size() < 2 || rates.empty() || rates.front().from_s > turned.times_s.back() ||
        rates.back().to_s < turned.times_s.front())
      throw badInput(place(), "does not overlap in time with the log",
                     "Give its times in seconds since the log's start, or since 1970 as the log has them");
    AngularSpeedSeries of_body;
    for (const BodyRate& rate : rates)
      for (double t = rate.from_s; t < rate.to_s; t += AngularSpeedSeries::kBin_s)
        of_body.add(t, rate.rate_rad_s);
    const ClockAgreement clocks = crossCorrelateClocks(of_imu, of_body, *input_.options);
    constexpr double kNear_s = 0.004;
    if (!clocks.moved) return 0.0;
    if (clocks.correlation < input_.options->same_motion) throwOther(poses, turned);
    const double later_s = std::abs(clocks.later_s) > kNear_s ? clocks.later_s : 0.0;
    for (TimedPose& pose : poses) pose.time_s += later_s;
    checkTurns(poses, turned);
    return later_s;
  }

  void checkLags(const TrajectoryRun& run) const {
    constexpr double kSigmas = 5.0;
    std::vector<double> levers, noises;
    bool far = false;
    for (const LagEstimate& lag : run.lags) {
      levers.push_back(lag.lever_m.norm());
      noises.push_back(lag.position_noise_m);
      far = far || lag.lever_m.norm() > kSigmas * lag.lever_sigma_m.norm();
    }
    const Eigen::Vector3d old_scale =
        accelerometerNumbers(input_.before.result->state.imus[imu_]).segment<3>(3);
    const double scale = (run.sum.now.segment<3>(3).array() / old_scale.array()).mean();
    const double sigma = std::sqrt(run.sum.covariance.diagonal().segment<3>(3).mean());
    if (std::abs(scale - 1.0) > input_.options->trajectory_scale + kSigmas * sigma)
      throw badInput(place(),
                     fmt::format("its scale is {:.3g} times that of the accelerometer of {}: it is not in "
                                 "metres (a single camera cannot determine the scale)",
                                 1.0 / scale, name()),
                     "Scale it to metres");
    const double lever_m = medianOf(std::move(levers));
    if (far && 1e3 * lever_m > input_.options->trajectory_lever_mm)
      throw badInput(place(),
                     fmt::format("its positions are of a point {:.0f} mm from {}, or not in metres",
                                 1e3 * lever_m, name()),
                     "Give the trajectory of the IMU itself, in metres");
  }

 private:
  void checkTurns(const std::vector<TimedPose>& poses, const TurnedRates& turned) const {
    constexpr double kExplained = 0.9, kTurned_rad = kRadPerDeg;
    const TurnAgreement agreement = agreementOf(ratesOf(poses, unchanged), turned);
    if (agreement.correlation < kExplained) throwOther(poses, turned);
    const double angle = agreement.imu_from_body.angularDistance(Eigen::Quaterniond::Identity());
    if (angle < kTurned_rad) return;
    const std::string body = bodyOf(input_.before, imu_, agreement.imu_from_body);
    throw badInput(place(),
                   fmt::format("it is not of {}, but of another frame, rotated by {:.1f} deg{}", name(),
                               angle * kDegPerRad, body.empty() ? "" : ": that of " + body),
                   "Give the poses world_from_imu of this IMU");
  }

  [[noreturn]] void throwOther(const std::vector<TimedPose>& poses, const TurnedRates& turned) const {
    constexpr double kExplained = 0.9;
    const double of_inverse = agreementOf(ratesOf(poses, inverted), turned).correlation,
                 of_order = agreementOf(ratesOf(poses, realPartFirst), turned).correlation;
    if (of_order > kExplained && of_order > of_inverse)
      throw badInput(place(), "its quaternions are in the order w, x, y, z", "Write x, y, z, w");
    if (of_inverse > kExplained)
      throw badInput(place(), "its poses are imu_from_world", "Give world_from_imu: the inverse of each");
    throw badInput(place(), fmt::format("its rotation does not match that of {}", name()),
                   "Give the trajectory of this log, with times on its clock");
  }

  const MaintainInput& input_;
  std::size_t imu_;
};

// Calls use(time, sample) for the IMU's samples until it returns that they are enough.
void forSamples(const MaintainInput& input, std::size_t imu, const RunContext& context,
                const std::function<bool(double, const ImuSample&)>& use) {
  ImuLogs logs(input.logs, input.before, input.settings, input.readings, context.stop);
  SensorPacket packet;
  while (logs.read(packet)) {
    context.throwIfStopped();
    if (packet.sensor != imu) continue;
    for (const ImuSample& sample : packet.imu_samples)
      if (!use(secondsSince(logs.start_ns(), sample.time_ns), sample)) return;
    context.progress.stageProgress(logs.fractionRead());
  }
  context.throwIfStopped();
}

}  // namespace

TrajectoryRun runTrajectory(const MaintainInput& input, std::size_t imu, double gravity_m_s2,
                            const RunContext& context) {
  context.progress.stageStarted("trajectory");
  const ImuState& before = input.before.result->state.imus[imu];
  std::int64_t start_ns = 0;
  {
    const ImuLogs logs(input.logs, input.before, input.settings, input.readings, context.stop);
    start_ns = logs.start_ns();
  }
  std::vector<TimedPose> poses = readTrajectory(input.trajectory, start_ns);
  TurnedRates turned;
  AngularSpeedSeries norms;
  const double from_s = poses.front().time_s - 2.0, to_s = poses.front().time_s + kLook_s + 2.0;
  const Eigen::Matrix3d rates = before.gyroscopeMatrix().inverse();
  forSamples(input, imu, context, [&](double time_s, const ImuSample& sample) {
    const Eigen::Vector3d rate = rates * (sample.angular_rate_rad_s - before.gyroscope_bias_rad_s);
    if (time_s >= from_s) {
      turned.add(time_s, rate);
      norms.add(time_s, rate);
    }
    return time_s < to_s;
  });
  const TrajectoryCheck check(input, imu);
  TrajectoryRun run;
  run.later_s = check.agree(poses, turned, norms);
  TrajectorySegment lags(std::move(poses), before, gravity_m_s2,
                         input.before.imus[imu].noise.accelerometer_density, *input.options);
  forSamples(input, imu, context, [&](double time_s, const ImuSample& sample) {
    lags.add(time_s, sample);
    return true;
  });
  lags.finish();
  run.lags = lags.lags();
  if (run.lags.empty()) return run;
  run.sum = sumOfLags(run.lags, accelerometerNumbers(before));
  check.checkLags(run);
  return run;
}

namespace {

constexpr std::size_t kNumbersInRow = 8;
// Poses closer in time than this are skipped.
constexpr double kNearest_s = 0.0095;
constexpr double kEpoch_s = 1e8;

bool isComment(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first == std::string::npos || line[first] == '#' ||
         (std::isalpha(static_cast<unsigned char>(line[first])) != 0);
}

std::array<double, kNumbersInRow> numbersOf(const std::string& line, const std::string& place) {
  std::array<double, kNumbersInRow> numbers = {};
  const char* at = line.c_str();
  for (double& number : numbers) {
    while (*at == ' ' || *at == '\t' || *at == ',' || *at == ';') ++at;
    const std::size_t length = std::strcspn(at, " \t,;\r");
    const std::optional<double> read = realFrom({at, length});
    if (!read)
      throw badInput(place, "does not have eight numbers",
                     "Give trajectory.csv of a calibration, or lines 'time x y z qx qy qz qw'");
    number = *read;
    at += length;
  }
  return numbers;
}

TimedPose poseFrom(const std::array<double, kNumbersInRow>& n, double start_s, const std::string& place) {
  TimedPose pose;
  pose.time_s = std::abs(n[0]) > kEpoch_s ? n[0] - start_s : n[0];
  pose.position_m = {n[1], n[2], n[3]};
  pose.world_from_imu = Eigen::Quaterniond(n[7], n[4], n[5], n[6]);
  constexpr double kOff = 0.01;
  if (std::abs(pose.world_from_imu.norm() - 1.0) > kOff)
    throw badInput(place, "its last four numbers are not a rotation: a quaternion x, y, z, w of length 1",
                   "Give lines 'time x y z qx qy qz qw'");
  pose.world_from_imu.normalize();
  return pose;
}

}  // namespace

std::vector<TimedPose> readTrajectory(const std::filesystem::path& file, std::int64_t log_start_ns) {
  std::ifstream stream(file);
  if (!stream)
    throw badInput(file.string(), "the file cannot be opened", "Check the path and its permissions");
  const double start_s = static_cast<double>(log_start_ns) / kNanosecondsPerSecond;
  std::vector<TimedPose> poses;
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line); ++number) {
    if (isComment(line)) continue;
    const std::string place = fmt::format("{} (line {})", file.string(), number);
    const TimedPose pose = poseFrom(numbersOf(line, place), start_s, place);
    if (!poses.empty() && pose.time_s < poses.back().time_s)
      throw badInput(place, "time runs backwards", "Sort the trajectory by time");
    if (poses.empty() || pose.time_s - poses.back().time_s > kNearest_s) poses.push_back(pose);
  }
  constexpr std::size_t kFewest = 20;
  if (poses.size() < kFewest)
    throw badInput(file.string(), "has only " + counted(poses.size(), "pose"),
                   "Give trajectory.csv of a calibration, or lines 'time x y z qx qy qz qw'");
  return poses;
}

}  // namespace evical
