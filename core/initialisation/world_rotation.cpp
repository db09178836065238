#include "core/initialisation/world_rotation.h"

namespace evical {
namespace {

constexpr int kSamplesPerKnot = 4;

}  // namespace

So3Spline fitWorldRotation(std::span<const AlignedCamera> cameras, const GyroRotation& gyro, double begin_s,
                           double end_s, double knot_spacing_s, double drift_knot_s) {
  std::vector<double> times_s;
  std::vector<Eigen::Quaterniond> world_from_first;
  for (const AlignedCamera& camera : cameras) {
    const Eigen::Quaterniond camera_from_imu = camera.hand_eye.reference_from_sensor.conjugate();
    for (const CameraPose& pose : camera.poses) {
      const double time_s = pose.time_s + camera.hand_eye.time_offset_s;
      if (time_s < begin_s || time_s > end_s) continue;
      times_s.push_back(time_s);
      world_from_first.push_back(pose.world_from_camera.rotation * camera_from_imu *
                                 gyro.at(time_s).conjugate());
    }
  }
  const So3Spline drift = fitSo3Spline(times_s, world_from_first, begin_s, end_s, drift_knot_s);
  std::vector<double> sample_times_s;
  std::vector<Eigen::Quaterniond> rotations;
  const int count = segmentsToCover(begin_s, end_s, knot_spacing_s) * kSamplesPerKnot;
  for (int k = 0; k <= count; ++k) {
    const double time_s = begin_s + (end_s - begin_s) * k / count;
    sample_times_s.push_back(time_s);
    rotations.push_back(Eigen::Quaterniond(evaluate(drift, time_s, RotationOrder::Rotation).rotation) *
                        gyro.at(time_s));
  }
  return fitSo3Spline(sample_times_s, rotations, begin_s, end_s, knot_spacing_s);
}

}  // namespace evical
