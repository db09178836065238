#include "core/initialisation/additional_imus.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/base/time.h"
#include "core/data/unfit_samples.h"
#include "core/geometry/so3.h"
#include "core/geometry/trajectory.h"
#include "core/initialisation/time_offset.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace evical {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// The gyroscope's own rotation as a list of poses.
std::vector<CameraPose> turnsOf(const GyroRotation& gyro) {
  constexpr double kStep_s = 0.02;
  std::vector<CameraPose> poses;
  for (double time_s = gyro.begin_s(); time_s <= gyro.end_s(); time_s += kStep_s) {
    CameraPose& pose = poses.emplace_back();
    pose.time_s = time_s;
    pose.world_from_camera.rotation = gyro.at(time_s);
  }
  return poses;
}

}  // namespace

ImuRotation alignFurtherGyroscope(const ImuData& imu, std::int64_t start_ns, const GyroRotation& reference,
                                  const InitialisationOptions& options, const RunContext& context) {
  const std::vector<CameraPose> turns = turnsOf(GyroRotation(withoutRateSpikes(imu.samples), start_ns));
  const std::vector<TimeOffsetPeak> peaks = correlateTimeOffset(turns, reference, options, imu.prior);
  const std::optional<KnownNumber>& known = imu.prior.time_offset;
  const bool given = isGiven(known);
  const std::string offsets =
      given   ? fmt::format("the given time offset of {:.4f} s", known->value)
      : known ? fmt::format("any time offset within {:.1f} s of {:.4f} s", options.time_offset_search_s,
                            known->value)
              : fmt::format("any time offset up to {:.1f} s", options.time_offset_search_s);
  const std::string advice = given ? "check the time offset " + howTo(HowTo::EditSession)
                                   : "widen initialisation.time_offset_search_s";
  if (peaks.empty()) {
    throw calibrationFailed(
        imu.name,
        fmt::format("its samples overlap with the reference's for less than {:.1f} s at {}",
                    options.min_overlap_s, offsets),
        "Check the clocks, or " + advice);
  }
  std::optional<ImuRotation> best;
  for (const TimeOffsetPeak& peak : peaks) {
    context.throwIfStopped();
    const auto found = estimateCameraImuRotation(turns, reference, peak.time_offset_s, options, imu.prior);
    if (found && (!best || found->cost < options.better_alignment * best->hand_eye.cost))
      best = ImuRotation{*found, peak.correlation};
  }
  if (!best || best->correlation < options.clear_peak_correlation) {
    throw calibrationFailed(
        imu.name,
        fmt::format("its rotation rates do not agree with the reference's at {} (correlation {:.2f})",
                    offsets, peaks.front().correlation),
        "Check that both are on the same rigid rig and were recorded at the same time, or " + advice);
  }
  // The estimated bias is that of the reference relative to this IMU: minus this IMU's bias.
  RelativeRotation& hand_eye = best->hand_eye;
  hand_eye.gyroscope_bias_rad_s =
      -(hand_eye.reference_from_sensor.conjugate() * hand_eye.gyroscope_bias_rad_s);
  return *best;
}

LeverArm solveLeverArm(const ImuData& imu, std::int64_t start_ns, const ImuRotation& rotation,
                       const CalibrationState& state, const InitialisationOptions& options) {
  const Eigen::Matrix3d reference_from_imu = rotation.hand_eye.reference_from_sensor.toRotationMatrix();
  Matrix6 matrix = Matrix6::Zero();
  Vector6 vector = Vector6::Zero();
  double squares = 0.0, count = 0.0;
  for (const ImuSample& sample : withFitForces(imu.samples)) {
    const double time_s = secondsSince(start_ns, sample.time_ns) + rotation.hand_eye.time_offset_s;
    if (!state.world_from_imu_rotation.contains(time_s) || !state.imu_in_world_m.contains(time_s)) continue;
    const MotionSample motion = motionAt(state.world_from_imu_rotation, state.imu_in_world_m, time_s);
    const Eigen::Vector3d at_reference =
        motion.world_from_imu.rotation.conjugate() * (motion.acceleration_m_s2 - state.gravity_in_world_m_s2);
    const Eigen::Matrix3d turning = skew(motion.angular_velocity_rad_s);
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian << skew(motion.angular_acceleration_rad_s2) + turning * turning, reference_from_imu;
    const Eigen::Vector3d more = reference_from_imu * sample.specific_force_m_s2 - at_reference;
    matrix += jacobian.transpose() * jacobian;
    vector += jacobian.transpose() * more;
    squares += more.squaredNorm();
    count += 1.0;
  }
  const double noise2 = options.acceleration_sigma_m_s2 * options.acceleration_sigma_m_s2;
  const double lever2 = options.translation_sigma_m * options.translation_sigma_m,
               bias2 = options.accelerometer_bias_sigma_m_s2 * options.accelerometer_bias_sigma_m_s2;
  Matrix6 with_priors = matrix;
  with_priors.diagonal().head<3>().array() += noise2 / lever2;
  with_priors.diagonal().tail<3>().array() += noise2 / bias2;
  const Vector6 solution = with_priors.ldlt().solve(vector);
  LeverArm lever{solution.head<3>(), solution.tail<3>(), 0.0, 0.0};
  squares += solution.dot(matrix * solution) - 2.0 * solution.dot(vector);
  lever.force_rms_m_s2 = std::sqrt(std::max(0.0, squares) / std::max(1.0, count));
  const Eigen::Matrix3d covariance = (noise2 * with_priors.inverse()).topLeftCorner<3, 3>();
  lever.std_m = std::sqrt(
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly).eigenvalues()(2));
  return lever;
}

}  // namespace evical
