#include "core/pipeline/rig/assessed_motion.h"

#include "core/base/time.h"

#include <vector>

namespace evical {
namespace {

Eigen::Vector3d spreadOf(const std::vector<Eigen::Vector3d>& values) {
  const double count = static_cast<double>(values.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& value : values) mean += value / count;
  for (const Eigen::Vector3d& value : values) squares += (value - mean).cwiseAbs2() / count;
  return squares.cwiseSqrt();
}

}  // namespace

AssessedMotion assessMotion(const ImuData& reference_imu, std::int64_t start_ns,
                            const CalibrationState* state) {
  const bool placed =
      state != nullptr && !state->cameras.empty() && state->world_from_imu_rotation.segmentCount() >= 1;
  const Eigen::Matrix3d shown_from_imu =
      placed ? state->cameras.front().reference_from_camera.rotation.conjugate().toRotationMatrix()
             : Eigen::Matrix3d::Identity();
  std::vector<Eigen::Vector3d> turns, accelerations;
  for (const ImuSample& sample : reference_imu.samples) {
    const double time_s = secondsSince(start_ns, sample.time_ns);
    if (placed && !state->world_from_imu_rotation.contains(time_s)) continue;
    Eigen::Vector3d acceleration = sample.specific_force_m_s2;
    if (placed)
      acceleration +=
          evaluate(state->world_from_imu_rotation, time_s, RotationOrder::Rotation).rotation.transpose() *
          state->gravity_in_world_m_s2;
    turns.push_back(shown_from_imu * sample.angular_rate_rad_s);
    accelerations.push_back(shown_from_imu * acceleration);
  }
  return {spreadOf(turns), spreadOf(accelerations), placed};
}

}  // namespace evical
